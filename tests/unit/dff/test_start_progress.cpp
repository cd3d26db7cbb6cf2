/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/start_progress.h"

#include <gtest/gtest.h>
#include <optional>

namespace {

class StartProgress : public testing::Test {
protected:
    StartProgress()
    {
        gst_init(nullptr, nullptr);
        element_ = GST_ELEMENT(gst_object_ref_sink(gst_bin_new(nullptr)));
        bus_ = gst_bus_new();
        gst_element_set_bus(element_, bus_);
    }

    ~StartProgress() override
    {
        gst_element_set_bus(element_, nullptr);
        gst_object_unref(bus_);
        gst_object_unref(element_);
    }

    std::optional<GstProgressType> next_message(GstClockTime patience)
    {
        g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(bus_, patience, GST_MESSAGE_PROGRESS);
        if (!message)
            return std::nullopt;
        GstProgressType type{};
        gst_message_parse_progress(message, &type, nullptr, nullptr);
        return type;
    }

    GstElement *element_ = nullptr;
    GstBus *bus_ = nullptr;
};

} // namespace

TEST_F(StartProgress, a_long_start_is_told_and_so_is_its_end)
{
    {
        const dff::StartProgress progress(element_);
        EXPECT_EQ(next_message(10 * GST_SECOND), GST_PROGRESS_TYPE_START);
    }
    EXPECT_EQ(next_message(0), GST_PROGRESS_TYPE_COMPLETE);
}

TEST_F(StartProgress, a_short_start_is_silent)
{
    {
        const dff::StartProgress progress(element_);
    }
    EXPECT_EQ(next_message(0), std::nullopt);
}
