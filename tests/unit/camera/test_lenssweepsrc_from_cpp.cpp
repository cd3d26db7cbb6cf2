/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* An application in C++: takes planes of a (simulated) camera, and changes exposure, gain and rate while it
 * runs. It knows nothing of this project but the public headers. */
#include <gst/app/app.h>
#include <gst/dff/dff.h>
#include <gst/gst.h>
#include <gtest/gtest.h>
#include <memory>

namespace {

struct Unref {
    void operator()(gpointer object) const { gst_object_unref(object); }
    void operator()(GstSample *sample) const { gst_sample_unref(sample); }
};
template <typename Object> using Owned = std::unique_ptr<Object, Unref>;

class Application : public testing::Test {
protected:
    Application()
        : pipeline_(gst_pipeline_new("sweep")), camera_(make("lenssweepsrc", "camera")),
          sink_(make("appsink", "planes"))
    {
        gst_util_set_object_arg(G_OBJECT(camera_.get()), "trigger", "free-run");
        g_object_set(camera_.get(), "camera", "Fake_1", "planes", 3U, "rate", 20.0, nullptr);
        g_object_set(sink_.get(), "sync", FALSE, "max-buffers", 4U, "drop", TRUE, nullptr);
        gst_bin_add_many(GST_BIN(pipeline_.get()), camera_.get(), sink_.get(), nullptr);
        EXPECT_TRUE(gst_element_link(camera_.get(), sink_.get()));
        play();
    }
    ~Application() override { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }

    void play() { gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING); }

    Owned<GstSample> pull()
    {
        return Owned<GstSample>(gst_app_sink_try_pull_sample(GST_APP_SINK(sink_.get()), 20 * GST_SECOND));
    }

    static const GstFocusMeta *focus_of(const Owned<GstSample> &sample)
    {
        return gst_buffer_get_focus_meta(gst_sample_get_buffer(sample.get()));
    }

    Owned<GstElement> pipeline_;
    Owned<GstElement> camera_;
    Owned<GstElement> sink_;

private:
    static Owned<GstElement> make(const char *factory, const char *name)
    {
        return Owned<GstElement>(GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make(factory, name))));
    }
};

} // namespace

TEST_F(Application, planes_have_labels)
{
    for (int i = 0; i < 6; i++) {
        const auto sample = pull();
        ASSERT_TRUE(sample);
        const GstFocusMeta *focus = focus_of(sample);
        ASSERT_NE(focus, nullptr);
        EXPECT_EQ(focus->planes, 3U);
        EXPECT_LT(focus->plane, 3U);
        EXPECT_DOUBLE_EQ(focus->power, 5.0 - 2.5 * focus->plane);
    }
}

TEST_F(Application, exposure_gain_and_rate_change_while_running)
{
    ASSERT_TRUE(pull());
    g_object_set(camera_.get(), "exposure", 3000.0, "gain", 2.0, "rate", 10.0, nullptr);
    bool changed = false;
    for (int i = 0; i < 200 && !changed; i++) {
        const auto sample = pull();
        ASSERT_TRUE(sample);
        gint frames = 0;
        gint seconds = 1;
        gst_structure_get_fraction(gst_caps_get_structure(gst_sample_get_caps(sample.get()), 0), "framerate",
                                   &frames, &seconds);
        changed = focus_of(sample)->exposure == 3 * GST_MSECOND && frames == 30 * seconds;
    }
    EXPECT_TRUE(changed);
    gdouble gain = 0;
    g_object_get(camera_.get(), "gain", &gain, nullptr);
    EXPECT_DOUBLE_EQ(gain, 2.0);
}

TEST_F(Application, stats_count_what_was_delivered)
{
    for (int i = 0; i < 5; i++)
        ASSERT_TRUE(pull());
    g_autoptr(GstStructure) stats = nullptr;
    g_object_get(camera_.get(), "stats", &stats, nullptr);
    guint64 delivered = 0;
    ASSERT_TRUE(gst_structure_get_uint64(stats, "delivered", &delivered));
    EXPECT_GE(delivered, 5U);
}

TEST_F(Application, a_pipeline_can_be_started_again_and_a_plane_kept)
{
    Owned<GstSample> kept;
    for (int i = 0; i < 3; i++) {
        kept = pull();
        ASSERT_TRUE(kept);
        gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
        play();
    }
    EXPECT_EQ(gst_buffer_get_size(gst_sample_get_buffer(kept.get())), 512U * 512U);
    EXPECT_TRUE(pull());
}

int main(int argc, char **argv)
{
    gst_init(&argc, &argv);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
