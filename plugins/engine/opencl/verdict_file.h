/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <filesystem>
#include <string>

namespace dff {

/* A line about a driver, kept in the cache folder beside the programs it built. While it lives, other
 * processes and threads wait for it; one that died lets go. Where the folder cannot be written there is
 * nothing to read. */
class VerdictFile {
public:
    /* `key` is all that the verdict depends on. Waits for whoever has the file. */
    explicit VerdictFile(const std::string &key);
    ~VerdictFile();

    VerdictFile(const VerdictFile &) = delete;
    VerdictFile &operator=(const VerdictFile &) = delete;

    /* Empty where none was written for the key. */
    std::string read() const;
    void write(const std::string &verdict) const;

    const std::filesystem::path &path() const { return path_; }

private:
    std::string key_;
    std::filesystem::path path_;
    int lock_ = -1;
};

} // namespace dff
