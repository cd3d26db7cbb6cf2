/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace dff {

using Record = std::span<const uint8_t>;

/* Records of at most 255 bytes, one after the other, each behind a byte with its length. */

/* Puts the record behind those in `list`. Throws std::length_error if it is longer than 255 bytes. */
void append_record(std::vector<uint8_t> &list, Record record);

/* The records of a list, in order; nothing if the last one is cut short. */
std::optional<std::vector<Record>> records_of(std::span<const uint8_t> list);

} // namespace dff
