/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/verdict_file.h"

#include "engine/opencl/program_file.h"

#include <fcntl.h>
#include <fstream>
#include <functional>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

namespace dff {

VerdictFile::VerdictFile(const std::string &key) : key_(key), path_(cache_folder())
{
    if (path_.empty())
        return;
    std::error_code error;
    std::filesystem::create_directories(path_, error);
    path_ /= std::to_string(std::hash<std::string>()(key_)) + ".verdict";
    lock_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock_ >= 0)
        flock(lock_, LOCK_EX);
}

VerdictFile::~VerdictFile()
{
    if (lock_ >= 0)
        close(lock_);
}

/* A file is the verdict, an end of line and the key, for people to read too. */
std::string VerdictFile::read() const
{
    std::ifstream file(path_);
    std::string verdict;
    std::getline(file, verdict);
    const std::string key(std::istreambuf_iterator<char>(file), {});
    return key == key_ ? verdict : std::string();
}

void VerdictFile::write(const std::string &verdict) const
{
    if (lock_ >= 0)
        std::ofstream(path_) << verdict << '\n' << key_;
}

} // namespace dff
