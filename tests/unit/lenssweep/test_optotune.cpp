/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fake_optotune.h"
#include "support.h"

#include <filesystem>
#include <gtest/gtest.h>

namespace {

std::string description(const FakeOptotune &driver, const std::string &rest)
{
    return "videotestsrc is-live=true ! video/x-raw,width=64,height=64,framerate=100/1 ! lenssweeptag "
           "name=tag "
           "mode=step settle-frames=0 planes=3 near=3 far=0 lens=optotune:" +
           driver.device() + " ! " + rest;
}

using Moves = std::vector<std::string>;

} // namespace

TEST(OptotuneSweep, planes_are_labelled_in_turn_with_powers_and_codes)
{
    FakeOptotune driver;
    {
        Pipeline pipeline(description(driver, "appsink name=out max-buffers=100"));
        pipeline.set_state(GST_STATE_PLAYING);
        for (unsigned i = 0; i < 9; i++) {
            const Sample sample = pipeline.pull("out");
            ASSERT_TRUE(sample);
            const GstFocusMeta *focus = focus_of(sample);
            EXPECT_EQ(focus->sweep, i / 3);
            EXPECT_EQ(focus->plane, i % 3);
            EXPECT_DOUBLE_EQ(focus->power, 3.0 - 1.5 * focus->plane);
            EXPECT_EQ(focus->code, 600 - 300 * static_cast<int>(focus->plane));
        }
        pipeline.set_state(GST_STATE_NULL);
    }
    const Moves moves = driver.moves();
    ASSERT_GE(moves.size(), 10U);
    for (size_t k = 0; k < 9; k++)
        EXPECT_EQ(moves[k], (Moves{"3 D", "1.5 D", "0 D"})[k % 3]);
    EXPECT_EQ(moves.back(), "0 mA");
}

TEST(OptotuneSweep, unplugged_in_mid_sweep_ends_in_an_error_and_it_may_come_back)
{
    auto driver = std::make_unique<FakeOptotune>();
    Pipeline pipeline(description(*driver, "appsink name=out max-buffers=100"));
    pipeline.set_state(GST_STATE_PLAYING);
    ASSERT_TRUE(pipeline.pull("out"));
    ASSERT_TRUE(pipeline.pull("out"));
    driver->unplug();
    const std::string error = pipeline.wait();
    EXPECT_NE(error.find("unplugged"), std::string::npos) << error;
    pipeline.set_state(GST_STATE_NULL);

    driver = std::make_unique<FakeOptotune>();
    g_object_set(pipeline.element("tag"), "lens", ("optotune:" + driver->device()).c_str(), nullptr);
    pipeline.set_state(GST_STATE_PLAYING);
    EXPECT_TRUE(pipeline.pull("out"));
}

TEST(OptotuneSweep, a_hot_lens_ends_in_an_error_that_says_so)
{
    FakeOptotune driver;
    driver.set_temperature(80);
    Pipeline pipeline(description(driver, "fakesink"));
    const std::string error = pipeline.run();
    EXPECT_NE(error.find("80 degrees Celsius"), std::string::npos) << error;
}

TEST(OptotuneSweep, what_is_wrong_at_the_start_is_told)
{
    FakeOptotune driver;
    Pipeline range(description(driver, "fakesink"));
    g_object_set(range.element("tag"), "near", 9.0, nullptr);
    const std::string error = range.run();
    EXPECT_NE(error.find("-1.5 to 3.5 dioptres"), std::string::npos) << error;
    driver.unplug();
    Pipeline missing(description(driver, "fakesink"));
    const std::string gone = missing.run();
    EXPECT_NE(gone.find("cannot open the serial port"), std::string::npos) << gone;
    EXPECT_NE(gone.find("on this machine"), std::string::npos) << gone;
}

TEST(OptotuneSweep, two_hundred_starts_leave_nothing_open)
{
    FakeOptotune driver;
    Pipeline pipeline(description(driver, "fakesink"));
    const auto open_files = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                             std::filesystem::directory_iterator());
    };
    decltype(open_files()) before = 0;
    for (int cycle = 0; cycle < 200; cycle++) {
        ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
        ASSERT_EQ(pipeline.set_state(GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
        if (cycle == 0)
            before = open_files();
    }
    EXPECT_EQ(open_files(), before);
    EXPECT_EQ(driver.moves().back(), "0 mA");
}

TEST(Lenses, are_listed_and_make_taggers)
{
    g_autoptr(GstDeviceProvider) provider =
        gst_device_provider_factory_get_by_name("focuslensdeviceprovider");
    ASSERT_NE(provider, nullptr);
    GList *devices = gst_device_provider_get_devices(provider); /* none on most machines */
    for (GList *item = devices; item; item = item->next) {
        auto *device = GST_DEVICE(item->data);
        EXPECT_TRUE(gst_device_has_classes(device, "Filter/Video"));
        g_autoptr(GstElement) element = gst_device_create_element(device, nullptr);
        ASSERT_NE(element, nullptr);
        gst_object_ref_sink(element);
        g_autofree gchar *lens = nullptr;
        g_object_get(element, "lens", &lens, nullptr);
        g_autoptr(GstStructure) properties = gst_device_get_properties(device);
        EXPECT_STREQ(lens, gst_structure_get_string(properties, "lens.uri"));
    }
    g_list_free_full(devices, gst_object_unref);
}
