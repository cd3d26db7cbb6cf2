/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

/* What libFuzzer calls: once, and for each input. */
extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

namespace dff {

/* Reads the input as a file of that name; a refusal with words is what is wanted of most. */
void read_as_file(const uint8_t *data, size_t size, const std::function<void(const std::string &path)> &read);

/* Ends the program, as a fault found, unless it holds. */
void require(bool holds);

} // namespace dff
