/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fuzz.h"

#include <cstdlib>
#include <stdexcept>
#include <sys/mman.h>
#include <unistd.h>

namespace dff {

void read_as_file(const uint8_t *data, size_t size, const std::function<void(const std::string &path)> &read)
{
    const int file = memfd_create("input", MFD_CLOEXEC);
    require(file >= 0 && write(file, data, size) == static_cast<ssize_t>(size));
    try {
        read("/proc/self/fd/" + std::to_string(file));
    } catch (const std::invalid_argument &error) {
        require(*error.what() != '\0');
    } catch (const std::runtime_error &error) {
        require(*error.what() != '\0');
    }
    close(file);
}

void require(bool holds)
{
    if (!holds)
        std::abort();
}

} // namespace dff
