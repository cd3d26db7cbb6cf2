/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "rtp/record_list.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <stdexcept>

namespace {

using Bytes = std::vector<uint8_t>;

TEST(RecordList, records_come_back_in_order)
{
    const Bytes first{1, 2, 3};
    const Bytes second(255, 7);
    Bytes list;
    dff::append_record(list, first);
    dff::append_record(list, second);
    dff::append_record(list, {});

    const auto records = dff::records_of(list);

    ASSERT_TRUE(records);
    ASSERT_EQ(records->size(), 3U);
    EXPECT_TRUE(std::equal(first.begin(), first.end(), records->at(0).begin(), records->at(0).end()));
    EXPECT_TRUE(std::equal(second.begin(), second.end(), records->at(1).begin(), records->at(1).end()));
    EXPECT_TRUE(records->at(2).empty());
}

TEST(RecordList, a_list_cut_short_anywhere_is_refused_or_whole)
{
    Bytes list;
    dff::append_record(list, Bytes{1, 2, 3});
    dff::append_record(list, Bytes{4, 5});
    for (size_t length = 0; length <= list.size(); length++) {
        const bool whole = length == 0 || length == 4 || length == 7;
        EXPECT_EQ(dff::records_of(std::span(list).first(length)).has_value(), whole) << length;
    }
}

TEST(RecordList, too_long_a_record_is_an_error)
{
    Bytes list;
    EXPECT_THROW(dff::append_record(list, Bytes(256)), std::length_error);
    EXPECT_TRUE(list.empty());
}

} // namespace
