/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include <gst/dff/dff.h>

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

namespace {

using Bytes = std::vector<uint8_t>;

Bytes take(GBytes *bytes)
{
    gsize size = 0;
    const auto *data = static_cast<const uint8_t *>(g_bytes_get_data(bytes, &size));
    Bytes copy(data, data + size);
    g_bytes_unref(bytes);
    return copy;
}

/* Metas of the three kinds, to bytes and back. */
Bytes focus_bytes()
{
    g_autoptr(GstBuffer) buffer = gst_buffer_new();
    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.sweep = 1;
    focus.plane = 2;
    focus.planes = 6;
    focus.power = 0.125;
    return take(gst_focus_meta_to_bytes(gst_buffer_add_focus_meta(buffer, &focus)));
}

Bytes stack_bytes()
{
    g_autoptr(GstBuffer) buffer = gst_buffer_new();
    GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(buffer, 5, 3);
    meta->repeated = 0b100;
    return take(gst_focal_stack_meta_to_bytes(meta));
}

Bytes depth_bytes()
{
    g_autoptr(GstBuffer) buffer = gst_buffer_new();
    GstDepthInfo depth;
    gst_depth_info_init(&depth);
    depth.unit = GST_DEPTH_UNIT_MILLIMETRE;
    depth.scale = 1.0;
    depth.sequence = 77;
    return take(gst_depth_meta_to_bytes(gst_buffer_add_depth_meta(buffer, &depth)));
}

/* The bytes of the meta that was read, or nothing and the error's text. */
template <typename Meta>
Bytes read_and_write(const Bytes &bytes, Meta *(*read)(GstBuffer *, GBytes *, GError **),
                     GBytes *(*write)(const Meta *), std::string &error_text)
{
    g_autoptr(GstBuffer) buffer = gst_buffer_new();
    g_autoptr(GBytes) input = g_bytes_new(bytes.data(), bytes.size());
    g_autoptr(GError) error = nullptr;
    Meta *meta = read(buffer, input, &error);
    EXPECT_EQ(meta == nullptr, error != nullptr);
    error_text = error ? error->message : "";
    return meta ? take(write(meta)) : Bytes{};
}

struct Kind {
    const char *name;
    Bytes (*make)();
    Bytes (*again)(const Bytes &, std::string &);
};

const Kind kinds[] = {
    {"focus", focus_bytes,
     [](const Bytes &bytes, std::string &error) {
         return read_and_write(bytes, gst_buffer_add_focus_meta_from_bytes, gst_focus_meta_to_bytes, error);
     }},
    {"stack", stack_bytes,
     [](const Bytes &bytes, std::string &error) {
         return read_and_write(bytes, gst_buffer_add_focal_stack_meta_from_bytes,
                               gst_focal_stack_meta_to_bytes, error);
     }},
    {"depth", depth_bytes,
     [](const Bytes &bytes, std::string &error) {
         return read_and_write(bytes, gst_buffer_add_depth_meta_from_bytes, gst_depth_meta_to_bytes, error);
     }},
};

class MetaBytes : public testing::TestWithParam<Kind> {};

std::string name_of(const testing::TestParamInfo<Kind> &info)
{
    return info.param.name;
}

} // namespace

TEST_P(MetaBytes, come_back_as_they_were)
{
    std::string error;
    const Bytes bytes = GetParam().make();
    EXPECT_EQ(GetParam().again(bytes, error), bytes) << error;
}

TEST_P(MetaBytes, cut_short_anywhere_are_refused)
{
    const Bytes bytes = GetParam().make();
    for (size_t size = 0; size < bytes.size(); size++) {
        std::string error;
        EXPECT_TRUE(
            GetParam().again(Bytes(bytes.begin(), bytes.begin() + static_cast<long>(size)), error).empty());
        EXPECT_NE(error, "");
    }
}

TEST_P(MetaBytes, of_a_later_version_are_refused_with_both_versions)
{
    Bytes bytes = GetParam().make();
    bytes[1] = 9;
    std::string error;
    EXPECT_TRUE(GetParam().again(bytes, error).empty());
    EXPECT_NE(error.find("version 9"), std::string::npos) << error;
    EXPECT_NE(error.find("version 1"), std::string::npos) << error;
}

TEST_P(MetaBytes, of_another_kind_are_refused)
{
    for (const Kind &other : kinds)
        if (std::string(other.name) != GetParam().name) {
            std::string error;
            EXPECT_TRUE(GetParam().again(other.make(), error).empty());
            EXPECT_NE(error, "");
        }
}

TEST_P(MetaBytes, with_something_behind_are_refused)
{
    Bytes bytes = GetParam().make();
    bytes.push_back(0);
    std::string error;
    EXPECT_TRUE(GetParam().again(bytes, error).empty());
    EXPECT_NE(error, "");
}

TEST_P(MetaBytes, damaged_anyhow_never_crash)
{
    std::mt19937 random(1);
    const Bytes whole = GetParam().make();
    for (unsigned i = 0; i < 5000; i++) {
        Bytes bytes = whole;
        for (unsigned k = 0; k <= random() % 4; k++)
            bytes[random() % bytes.size()] = static_cast<uint8_t>(random());
        bytes.resize(random() % 3 ? bytes.size() : random() % bytes.size());
        std::string error;
        GetParam().again(bytes, error);
    }
}

INSTANTIATE_TEST_SUITE_P(Metas, MetaBytes, testing::ValuesIn(kinds), name_of);

TEST(DepthBytes, of_an_unknown_unit_are_refused)
{
    Bytes bytes = depth_bytes();
    bytes[2] = 200;
    std::string error;
    EXPECT_TRUE(kinds[2].again(bytes, error).empty());
}

TEST(StackBytes, of_impossible_numbers_of_planes_are_refused)
{
    for (const uint8_t planes : {0, 1, 65, 255}) {
        Bytes bytes = stack_bytes();
        bytes[10] = planes;
        std::string error;
        EXPECT_TRUE(kinds[1].again(bytes, error).empty()) << int(planes);
    }
}

TEST(StackBytes, of_planes_beyond_the_stack_are_refused)
{
    Bytes bytes = stack_bytes();
    bytes[19] = 0b1000; /* missing: plane 3 of 3 */
    std::string error;
    EXPECT_TRUE(kinds[1].again(bytes, error).empty());
}
