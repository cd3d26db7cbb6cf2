/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "common/memory_pool.h"

#include <gtest/gtest.h>
#include <memory>
#include <optional>

using namespace dff;

namespace {

struct MemoryUnref {
    void operator()(GstMemory *memory) const { gst_memory_unref(memory); }
};
using Memory = std::unique_ptr<GstMemory, MemoryUnref>;

constexpr size_t slack = 64;

void expect_zeros(const guint8 *bytes)
{
    for (size_t i = 0; i < slack; i++)
        EXPECT_EQ(bytes[i], 0);
}

} // namespace

/* Pages that nobody writes take no room, so that this can be tried anywhere. The sanitizer notes each byte,
 * which takes an eighth of the room. */
TEST(MemoryPool, sizes_around_four_gibibytes_are_whole)
{
    constexpr size_t four_gibibytes = size_t{1} << 32;
    for (const size_t bytes : {four_gibibytes - 4096, four_gibibytes, 3 * four_gibibytes / 2}) {
        MemoryPool pool(bytes, slack);
        const Memory memory(pool.acquire());
        ASSERT_TRUE(memory) << bytes;
        GstMapInfo map;
        ASSERT_TRUE(gst_memory_map(memory.get(), &map, GST_MAP_READWRITE));
        EXPECT_EQ(map.size, bytes);
        map.data[0] = map.data[bytes - 1] = 7;
        expect_zeros(map.data - slack);
        expect_zeros(map.data + bytes);
        gst_memory_unmap(memory.get(), &map);
    }
}

TEST(MemoryPool, what_comes_back_is_used_again)
{
    MemoryPool pool(1000, slack);
    Memory first(pool.acquire());
    const Memory second(pool.acquire());
    GstMapInfo map;
    gst_memory_map(first.get(), &map, GST_MAP_WRITE);
    const guint8 *place = map.data;
    gst_memory_unmap(first.get(), &map);
    gst_memory_resize(first.get(), 10, 20); /* as somebody downstream may */
    Memory part(gst_memory_share(first.get(), 0, 5));
    first.reset();
    const auto place_of = [](GstMemory *memory) {
        GstMapInfo found;
        gst_memory_map(memory, &found, GST_MAP_READ);
        gst_memory_unmap(memory, &found);
        return static_cast<const guint8 *>(found.data);
    };
    const Memory third(pool.acquire());
    EXPECT_NE(place_of(third.get()), place) << "a part of the first is still in use";
    part.reset();
    const Memory fourth(pool.acquire());
    EXPECT_EQ(place_of(fourth.get()), place);
    EXPECT_EQ(gst_memory_get_sizes(fourth.get(), nullptr, nullptr), 1000u);
}

TEST(MemoryPool, a_memory_outlives_its_pool)
{
    std::optional<MemoryPool> pool(std::in_place, 1000, slack);
    const Memory memory(pool->acquire());
    pool.reset();
    GstMapInfo map;
    ASSERT_TRUE(gst_memory_map(memory.get(), &map, GST_MAP_WRITE));
    map.data[999] = 1;
    gst_memory_unmap(memory.get(), &map);
}

TEST(MemoryPool, what_cannot_be_had_does_not_end_the_process)
{
    MemoryPool largest(SIZE_MAX, slack);
    EXPECT_EQ(largest.acquire(), nullptr);
}

TEST(MemoryPool, a_picture_may_take_half_of_the_machine)
{
    EXPECT_GT(largest_picture(), uint64_t{64} << 20);
    EXPECT_LT(largest_picture(), uint64_t{1} << 46);
}
