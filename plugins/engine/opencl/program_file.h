/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace dff {

/* gst-plugins-dff in $XDG_CACHE_HOME or ~/.cache; empty where there is no home. */
std::filesystem::path cache_folder();

/* What a driver built from a program, in the cache folder. A folder that cannot be written or a file that is
 * broken costs time only. */
class ProgramFile {
public:
    /* `key` is all that the result depends on: device, driver, options, source. */
    explicit ProgramFile(std::string key);

    std::optional<std::vector<unsigned char>> read() const;
    void write(const std::vector<unsigned char> &binary) const;

private:
    std::string key_;
    std::filesystem::path path_; /* empty where there is no home */
};

} // namespace dff
