/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* lenssweepsrc with the machine's lines and lenses, and the camera that Aravis simulates in this process: it
 * sends frames whether it is triggered or not, so that what it sends has no labels. */
#include "lens/linux_i2c_bus.h"
#include "lens/sweep_registers.h"
#include "rig.h"
#include "support.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <gtest/gtest.h>
#include <thread>

using namespace std::chrono_literals;
using dff::sweep_registers::Word;

namespace {

bool comes_true(const std::function<bool()> &what)
{
    for (int i = 0; i < 600 && !what(); i++)
        std::this_thread::sleep_for(100ms);
    return what();
}

guint64 statistic(GstElement *source, const char *name)
{
    g_autoptr(GstStructure) stats = nullptr;
    guint64 count = 0;
    g_object_get(source, "stats", &stats, nullptr);
    gst_structure_get_uint64(stats, name, &count);
    return count;
}

std::ptrdiff_t place(const std::vector<std::string> &log, const std::string &line)
{
    return std::find(log.begin(), log.end(), line) - log.begin();
}

/* The source with that sequencer, so slow that this machine's threads are in time. */
std::string counted_source()
{
    return "lenssweepsrc name=source camera=Fake_1 trigger=line sync-line=SYNC lens=fpga:" + rig::i2c_bus() +
           " planes=6 rate=3 ! fakesink";
}

/* What the sequencer says of itself. */
void set_frame_count(uint16_t count)
{
    dff::LinuxI2cBus bus(rig::i2c_bus(), 0x3c);
    bus.write_word(static_cast<uint8_t>(Word::frame_count_low), count);
}

/* That it was started, and the count at rest read. */
bool sweeps()
{
    return comes_true([] {
        const auto log = rig::i2c_log();
        return place(log, "3c 02=0001") < static_cast<std::ptrdiff_t>(log.size());
    });
}

void pulse_sync_line()
{
    rig::pull(rig::sync_line, true);
    std::this_thread::sleep_for(10ms);
    rig::pull(rig::sync_line, false);
}

/* The text of the next warning on the bus; an error is a failure. */
std::string next_warning(Pipeline &pipeline)
{
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline.get());
    g_autoptr(GstMessage) message =
        gst_bus_pop_filtered(bus, static_cast<GstMessageType>(GST_MESSAGE_WARNING | GST_MESSAGE_ERROR));
    if (!message)
        return "";
    g_autoptr(GError) error = nullptr;
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING) {
        gst_message_parse_warning(message, &error, nullptr);
        return error->message;
    }
    gst_message_parse_error(message, &error, nullptr);
    ADD_FAILURE() << error->message;
    return "";
}

} // namespace

TEST(Source, loads_the_sequencer_then_raises_its_run_line_and_lowers_it_at_the_end)
{
    dff::LinuxI2cBus bus(rig::i2c_bus(), 0x3c);
    const auto word = [&](Word name) { return bus.read_word(static_cast<uint8_t>(name)); };
    Pipeline pipeline(
        "lenssweepsrc name=source camera=Fake_1 trigger=line run-line=RUN sync-line=SYNC lens=fpga:" +
        rig::i2c_bus() + " planes=6 near=5 far=0 rate=26 exposure=6000 ! fakesink");
    rig::empty_i2c_log();
    EXPECT_FALSE(rig::level(rig::run_line));
    pipeline.set_state(GST_STATE_PLAYING);
    ASSERT_TRUE(comes_true([] { return rig::level(rig::run_line); }));
    const auto log = rig::i2c_log();
    EXPECT_LT(place(log, "3c 0c=0001"), place(log, "3c 02=0003")) << "the table, then the start";
    EXPECT_LT(place(log, "3c 02=0003"), static_cast<std::ptrdiff_t>(log.size()));
    EXPECT_EQ(word(Word::planes), 6);
    EXPECT_EQ(word(Word::period_us), 6410);
    EXPECT_EQ(word(Word::exposure_us), 6000);
    int last = 1024;
    for (uint16_t plane = 0; plane < 6; ++plane) {
        bus.write_word(static_cast<uint8_t>(Word::plane_select), plane);
        EXPECT_LT(word(Word::plane_code_b), last) << "nearest first";
        last = word(Word::plane_code_b);
    }

    bus.write_word(static_cast<uint8_t>(Word::frame_count_low), 12);
    for (int edge = 0; edge < 3; ++edge) {
        pulse_sync_line();
    }
    pipeline.set_state(GST_STATE_NULL);
    EXPECT_EQ(statistic(pipeline.element("source"), "triggers"), 12U);
    EXPECT_FALSE(rig::level(rig::run_line));
    EXPECT_EQ(rig::i2c_log().back(), "3c 02=0000");
    bus.write_word(static_cast<uint8_t>(Word::frame_count_low), 0);
}

TEST(Source, holds_the_count_of_triggers_against_the_sync_line)
{
    for (const uint16_t count : {1, 6}) { /* the last trigger was of plane 0, as the edge says; of plane 5 */
        rig::empty_i2c_log();
        Pipeline pipeline(counted_source());
        pipeline.set_state(GST_STATE_PLAYING);
        ASSERT_TRUE(sweeps());
        set_frame_count(count);
        pulse_sync_line();
        const auto triggers = [&] { return statistic(pipeline.element("source"), "triggers"); };
        EXPECT_TRUE(comes_true([&] { return triggers() == count; }));
        pipeline.set_state(GST_STATE_NULL);
        EXPECT_EQ(statistic(pipeline.element("source"), "wrong-counts"), count == 1 ? 0U : 1U);
        set_frame_count(0);
    }
}

TEST(Source, a_count_that_cannot_be_read_is_a_warning)
{
    rig::empty_i2c_log();
    Pipeline pipeline(counted_source());
    pipeline.set_state(GST_STATE_PLAYING);
    ASSERT_TRUE(sweeps());
    rig::fail_i2c_transfers(3);
    bool told = false;
    EXPECT_TRUE(comes_true([&] {
        told = told || next_warning(pipeline).find("count of triggers") != std::string::npos;
        return told;
    }));
}

TEST(Source, moves_the_lens_from_plane_to_plane)
{
    rig::empty_i2c_log();
    Pipeline pipeline("lenssweepsrc name=source camera=Fake_1 trigger=software planes=3 near=5 far=0 rate=1 "
                      "lens=max14574:" +
                      rig::i2c_bus() + " ! fakesink");
    pipeline.set_state(GST_STATE_PLAYING);
    ASSERT_TRUE(comes_true([] { return rig::committed_codes().size() >= 7; }));
    pipeline.set_state(GST_STATE_NULL);
    const auto codes = rig::committed_codes();
    EXPECT_GT(codes[0], codes[1]) << "nearest first";
    EXPECT_GT(codes[1], codes[2]);
    /* From plane to plane, or to the first when the sweep is begun again: that camera's frames do not fit. */
    guint64 begun_again = 0;
    for (std::size_t i = 3; i < codes.size(); ++i) {
        const auto before = std::find(codes.begin(), codes.begin() + 3, codes[i - 1]) - codes.begin();
        if (codes[i] != codes[(before + 1) % 3]) {
            EXPECT_EQ(codes[i], codes[0]) << "move " << i;
            begun_again++;
        }
    }
    EXPECT_LE(begun_again, statistic(pipeline.element("source"), "restarts"));
    EXPECT_EQ(rig::i2c_log().back(), "77 03=00") << "asleep";
}
