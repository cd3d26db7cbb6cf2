/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "encoded_file.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStringAttribute.h>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

using namespace dff;

namespace {

constexpr unsigned width = 64;
constexpr unsigned height = 48;
const std::string dioptres = ",depth-unit=dioptre,depth-near=5.0,depth-far=0.0";

std::array<guint8, 3> colour_at(unsigned x, unsigned y)
{
    return {static_cast<guint8>(4 * x), static_cast<guint8>(5 * y), 128};
}

guint16 depth_at(unsigned x, unsigned y)
{
    return x == 0 ? 0 : static_cast<guint16>(1 + 65534 * y / (height - 1));
}

float linear(guint8 value)
{
    const double s = value / 255.0; /* IEC 61966-2-1 */
    return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

/* A file on disk, since that is what the readers want. */
class ExrOnDisk {
public:
    explicit ExrOnDisk(const EncodedFile &file)
        : name(testing::TempDir() + "file" + std::to_string(getpid()) + ".exr")
    {
        EXPECT_EQ(file.error, "");
        EXPECT_FALSE(file.bytes.empty());
        std::ofstream(name, std::ios::binary)
            .write(reinterpret_cast<const char *>(file.bytes.data()),
                   static_cast<std::streamsize>(file.bytes.size()));
    }
    ~ExrOnDisk() { unlink(name.c_str()); }

    const std::string name;
};

std::vector<float> read_channel(Imf::InputPart part, const char *channel)
{
    std::vector<float> pixels(width * height);
    Imf::FrameBuffer frame;
    frame.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char *>(pixels.data()), sizeof(float),
                                     sizeof(float) * width));
    part.setFrameBuffer(frame);
    part.readPixels(0, height - 1);
    return pixels;
}

void expect_depth(const std::vector<float> &z)
{
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < width; x++) {
            const float read = z[y * width + x];
            const double power = 5.0 * (65535 - depth_at(x, y)) / 65534;
            if (x == 0)
                EXPECT_TRUE(std::isnan(read));
            else if (y == height - 1)
                EXPECT_TRUE(std::isinf(read) || read > 1e12f); /* 0 dioptres, as far as a double goes */
            else
                EXPECT_NEAR(read, 1.0 / power, 1e-6 / power);
        }
}

EncodedFile picture(const std::string &properties, const std::string &caps = dioptres)
{
    return encode_file("depthexrenc " + properties, width, height, colour_frame(width, height, colour_at),
                       depth_frame(width, height, depth_at), caps);
}

/* In pixels of the depth; unknown in row 7. */
guint16 deviation_at(unsigned, unsigned y)
{
    return y == 7 ? 0 : static_cast<guint16>(20 + y);
}

/* The same depth from the first of ten planes to the last. */
Buffer frame_in_planes()
{
    GstDepthInfo depth;
    gst_depth_info_init(&depth);
    depth.scale = 9.0 / 65534;
    depth.offset = -depth.scale;
    Buffer frame = depth_frame(width, height, depth_at);
    gst_buffer_add_depth_meta(frame.get(), &depth);
    return frame;
}

float number(const Imf::Header &header, const char *name)
{
    const auto *attribute = header.findTypedAttribute<Imf::FloatAttribute>(name);
    return attribute ? attribute->value() : NAN;
}

std::vector<float> numbers(const Imf::Header &header, const char *name)
{
    const auto *attribute = header.findTypedAttribute<Imf::FloatVectorAttribute>(name);
    return attribute ? attribute->value() : std::vector<float>();
}

std::string text(const Imf::Header &header, const char *name)
{
    const auto *attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
    return attribute ? attribute->value() : "";
}

} // namespace

TEST(DepthExrEnc, depth_is_exact_in_every_compression)
{
    for (const char *compression : {"none", "rle", "zips", "zip", "piz", "dwaa", "dwab"}) {
        SCOPED_TRACE(compression);
        const ExrOnDisk file(picture(std::string("compression=") + compression));
        Imf::MultiPartInputFile exr(file.name.c_str());
        ASSERT_EQ(exr.parts(), 1);
        expect_depth(read_channel(Imf::InputPart(exr, 0), "Z"));
        const std::vector<float> red = read_channel(Imf::InputPart(exr, 0), "R");
        for (unsigned x = 0; x < width; x++)
            EXPECT_NEAR(red[x], linear(colour_at(x, 0)[0]),
                        std::string(compression).starts_with("dwa") ? 0.02 : 1e-3);
    }
}

TEST(DepthExrEnc, opencv_reads_the_colours)
{
    setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 1);
    const ExrOnDisk file(picture(""));
    const cv::Mat bgr = cv::imread(file.name, cv::IMREAD_UNCHANGED);
    ASSERT_EQ(bgr.cols, static_cast<int>(width));
    ASSERT_EQ(bgr.type(), CV_32FC3);
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < width; x++)
            for (unsigned c = 0; c < 3; c++)
                EXPECT_NEAR(
                    bgr.at<cv::Vec3f>(static_cast<int>(y), static_cast<int>(x))[static_cast<int>(2 - c)],
                    linear(colour_at(x, y)[c]), 1e-3);
}

TEST(DepthExrEnc, openexrdec_opens_it)
{
    const ExrOnDisk file(picture("compression=piz"));
    g_autoptr(GstElement) pipeline = gst_parse_launch(
        ("filesrc location=" + file.name + " ! openexrdec ! appsink name=out sync=false").c_str(), nullptr);
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    g_autoptr(GstElement) sink = gst_bin_get_by_name(GST_BIN(pipeline), "out");
    g_autoptr(GstSample) sample = nullptr;
    g_signal_emit_by_name(sink, "try-pull-sample", 20 * GST_SECOND, &sample);
    ASSERT_NE(sample, nullptr);
    g_autofree gchar *caps = gst_caps_to_string(gst_sample_get_caps(sample));
    EXPECT_NE(std::string(caps).find("width=(int)64"), std::string::npos) << caps;
    gst_element_set_state(pipeline, GST_STATE_NULL);
}

TEST(DepthExrEnc, the_facts_of_focus_and_camera_are_attributes)
{
    GstDepthInfo depth = dioptres_from_5_to_1();
    depth.has_intrinsics = TRUE;
    depth.fx = 100;
    depth.fy = 101;
    depth.cx = 31;
    depth.cy = 23;
    depth.distortion[1] = 0.25;
    Buffer frame = depth_frame(width, height, depth_at);
    gst_buffer_add_depth_meta(frame.get(), &depth);
    const ExrOnDisk file(encode_file("depthexrenc", width, height, colour_frame(width, height, colour_at),
                                     std::move(frame), ""));
    Imf::MultiPartInputFile exr(file.name.c_str());
    const Imf::Header &header = exr.header(0);
    EXPECT_EQ(text(header, "depthUnit"), "metre");
    EXPECT_EQ(number(header, "nearPower"), 5.0f);
    EXPECT_EQ(number(header, "farPower"), 1.0f);
    EXPECT_EQ(numbers(header, "intrinsics"), (std::vector<float>{100, 101, 31, 23}));
    EXPECT_EQ(numbers(header, "distortion"), (std::vector<float>{0, 0.25, 0, 0, 0}));
    EXPECT_EQ(header.channels().findChannel("R")->type, Imf::HALF);
    EXPECT_EQ(header.channels().findChannel("Z")->type, Imf::FLOAT);
}

/* By the slope of 1 / power; the table's ends and infinity are in it. */
TEST(DepthExrEnc, uncertainty_is_in_metres_too)
{
    const ExrOnDisk file(encode_file("depthexrenc", width, height, colour_frame(width, height, colour_at),
                                     depth_frame(width, height, depth_at), dioptres,
                                     {.uncertainty = depth_frame(width, height, deviation_at)}));
    Imf::MultiPartInputFile exr(file.name.c_str());
    const Imf::InputPart part(exr, 0);
    expect_depth(read_channel(part, "Z"));
    const std::vector<float> deviation = read_channel(part, "uncertainty.Z");
    for (unsigned y = 0; y + 1 < height; y++)
        for (unsigned x = 0; x < width; x++) {
            const double power = 5.0 * (65535 - depth_at(x, y)) / 65534;
            const double metres = 5.0 / 65534 * deviation_at(x, y) / (power * power);
            if (x == 0 || y == 7)
                EXPECT_TRUE(std::isnan(deviation[y * width + x]));
            else
                EXPECT_NEAR(deviation[y * width + x], metres, 1e-5 * metres);
        }
}

TEST(DepthExrEnc, uncertainty_of_plane_numbers_is_in_planes)
{
    const ExrOnDisk file(encode_file("depthexrenc", width, height, colour_frame(width, height, colour_at),
                                     frame_in_planes(), "",
                                     {.uncertainty = depth_frame(width, height, deviation_at)}));
    Imf::MultiPartInputFile exr(file.name.c_str());
    const std::vector<float> deviation = read_channel(Imf::InputPart(exr, 0), "uncertainty.Z");
    EXPECT_NEAR(deviation[3 * width + 5], 23 * 9.0 / 65534, 1e-8);
}

TEST(DepthExrEnc, plane_numbers_are_not_called_metres)
{
    const ExrOnDisk file(encode_file("depthexrenc", width, height, colour_frame(width, height, colour_at),
                                     frame_in_planes(), ""));
    Imf::MultiPartInputFile exr(file.name.c_str());
    EXPECT_EQ(text(exr.header(0), "depthUnit"), "plane");
    EXPECT_NEAR(read_channel(Imf::InputPart(exr, 0), "Z").back(), 9.0, 1e-5);
}

TEST(DepthExrEnc, a_whole_stack_is_a_multi_part_file)
{
    constexpr unsigned planes = 3;
    Buffer stack(gst_buffer_new_allocate(nullptr, size_t{3} * width * height * planes, nullptr));
    for (unsigned z = 0; z < planes; z++)
        gst_buffer_memset(stack.get(), size_t{3} * width * height * z, static_cast<guint8>(50 * z),
                          3 * width * height);
    GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(stack.get(), 7, planes);
    for (unsigned z = 0; z < planes; z++) {
        GstFocusInfo focus;
        gst_focus_info_init(&focus);
        focus.power = 4.0 - 2.0 * z;
        focus.exposure = 6 * GST_MSECOND;
        gst_focal_stack_meta_set_focus(meta, z, &focus);
    }
    const ExrOnDisk file(encode_file("depthexrenc", width, height, colour_frame(width, height, colour_at),
                                     depth_frame(width, height, depth_at), dioptres,
                                     {.stack = std::move(stack), .planes = planes}));
    Imf::MultiPartInputFile exr(file.name.c_str());
    ASSERT_EQ(exr.parts(), 1 + static_cast<int>(planes));
    EXPECT_EQ(exr.header(0).name(), "all-in-focus");
    EXPECT_EQ(numbers(exr.header(0), "focusPowers"), (std::vector<float>{4, 2, 0}));
    expect_depth(read_channel(Imf::InputPart(exr, 0), "Z"));
    for (int z = 0; z < static_cast<int>(planes); z++) {
        const Imf::Header &header = exr.header(1 + z);
        EXPECT_EQ(header.name(), "plane0" + std::to_string(z));
        EXPECT_EQ(number(header, "focusPower"), 4.0f - 2.0f * static_cast<float>(z));
        EXPECT_EQ(number(header, "focus"), z == 2 ? INFINITY : 1.0f / (4.0f - 2.0f * static_cast<float>(z)));
        EXPECT_NEAR(number(header, "expTime"), 0.006, 1e-6);
        EXPECT_EQ(header.channels().findChannel("Z"), nullptr);
        EXPECT_NEAR(read_channel(Imf::InputPart(exr, 1 + z), "G")[77], linear(static_cast<guint8>(50 * z)),
                    1e-3);
    }
}

TEST(DepthExrEnc, a_pad_that_is_not_linked_is_told)
{
    g_autoptr(GstElement) pipeline =
        gst_parse_launch("videotestsrc num-buffers=1 ! e.color depthexrenc name=e ! fakesink", nullptr);
    EXPECT_EQ(gst_element_set_state(pipeline, GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);
    g_autoptr(GstMessage) message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
    ASSERT_NE(message, nullptr);
    g_autoptr(GError) error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    EXPECT_NE(std::string(error->message).find("\"depth\" is not linked"), std::string::npos)
        << error->message;
    gst_element_set_state(pipeline, GST_STATE_NULL);
}
