/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/program_file.h"

#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <string_view>
#include <system_error>
#include <unistd.h>

namespace dff {

namespace {

/* Drivers do not forgive half a binary. */
std::string checksum(const std::vector<unsigned char> &binary)
{
    const std::string_view bytes(reinterpret_cast<const char *>(binary.data()), binary.size());
    return std::to_string(std::hash<std::string_view>()(bytes));
}

} // namespace

std::filesystem::path cache_folder()
{
    const char *cache = std::getenv("XDG_CACHE_HOME");
    if (cache && *cache)
        return std::filesystem::path(cache) / "gst-plugins-dff";
    const char *home = std::getenv("HOME");
    return home && *home ? std::filesystem::path(home) / ".cache" / "gst-plugins-dff"
                         : std::filesystem::path();
}

ProgramFile::ProgramFile(std::string key) : key_(std::move(key)), path_(cache_folder())
{
    if (!path_.empty())
        path_ /= std::to_string(std::hash<std::string>()(key_)) + ".program";
}

/* A file is the key (two keys may share a hash), a 0, the binary's checksum, a 0 and the binary. */
std::optional<std::vector<unsigned char>> ProgramFile::read() const
{
    std::ifstream file(path_, std::ios::binary);
    std::string key, sum;
    if (!std::getline(file, key, '\0') || key != key_ || !std::getline(file, sum, '\0'))
        return std::nullopt;
    std::vector<unsigned char> binary(std::istreambuf_iterator<char>(file), {});
    return sum == checksum(binary) ? std::optional(std::move(binary)) : std::nullopt;
}

/* Under another name first, so that nobody reads half a file. */
void ProgramFile::write(const std::vector<unsigned char> &binary) const
{
    if (path_.empty())
        return;
    std::error_code error;
    std::filesystem::create_directories(path_.parent_path(), error);
    std::filesystem::path unfinished = path_;
    unfinished += std::to_string(getpid()) + "-unfinished";
    std::ofstream file(unfinished, std::ios::binary);
    file << key_ << '\0' << checksum(binary) << '\0';
    file.write(reinterpret_cast<const char *>(binary.data()), static_cast<std::streamsize>(binary.size()));
    file.close();
    if (file)
        std::filesystem::rename(unfinished, path_, error);
    if (!file || error)
        std::filesystem::remove(unfinished, error);
}

} // namespace dff
