/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "rtp/record_list.h"

#include <limits>
#include <stdexcept>

namespace dff {

void append_record(std::vector<uint8_t> &list, Record record)
{
    if (record.size() > std::numeric_limits<uint8_t>::max())
        throw std::length_error("A record has more than 255 bytes");
    list.push_back(static_cast<uint8_t>(record.size()));
    list.insert(list.end(), record.begin(), record.end());
}

std::optional<std::vector<Record>> records_of(std::span<const uint8_t> list)
{
    std::vector<Record> records;
    while (!list.empty()) {
        const size_t length = list.front();
        list = list.subspan(1);
        if (length > list.size())
            return std::nullopt;
        records.push_back(list.first(length));
        list = list.subspan(length);
    }
    return records;
}

} // namespace dff
