/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "whole_file.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace dff {

void write_whole_file(const std::string &what, const std::string &path, const std::string &text)
{
    const std::string part = path + ".part";
    std::ofstream file(part, std::ios::binary);
    file << text;
    file.close();
    std::error_code error;
    if (file)
        std::filesystem::rename(part, path, error);
    if (!file || error)
        throw std::runtime_error(what + " " + path + " cannot be written" +
                                 (error ? ": " + error.message() : ""));
}

} // namespace dff
