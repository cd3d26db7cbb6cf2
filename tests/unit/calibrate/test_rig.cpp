/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* The simulated rig, measured by pictures alone. */
#include "board_collector.h"
#include "board_rig.h"
#include "calibration_file.h"
#include "focalstack/alignment_calibration.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace dff;

namespace {

/* Tells what BoardCollector tells. */
struct Seen {
    std::vector<BoardView> views;
    std::string told;
    std::vector<cv::Point> bad_pixels;
};

class Rig : public testing::Test {
protected:
    static Seen
    look(const std::vector<std::string> &poses, const Board &asked = rig.board(),
         const std::string &more = "breathing=0.03 field-curvature=0.5 vignetting=0.05 noise=moderate")
    {
        Seen seen;
        BoardCollector collector(asked, [&](const std::string &line) { seen.told += line + "\n"; });
        for (const std::string &pose : poses) {
            SweepReader reader(
                "lenssweeptestsrc num-buffers=6 planes=6 near=3.4 far=0.7 scene=board board=10x7x20 "
                "calibration=" +
                rig.camera() + " pose=" + pose + " " + more);
            while (const auto sweep = reader.next())
                collector.add(*sweep);
            collector.end_source();
        }
        seen.views = collector.views();
        seen.bad_pixels = collector.bad_pixels();
        return seen;
    }

    static inline const BoardRig rig;
};

} // namespace

TEST_F(Rig, twelve_boards_tell_what_the_lens_is)
{
    const Seen seen = look(rig.poses());
    ASSERT_EQ(seen.views.size(), 12u) << seen.told;
    const RigCalibration found = calibrate(rig.board(), seen.views);
    rig.expect_found(found);

    /* The camera draws a disk of 2 px by the share of each pixel, which is as wide as one of 2.54 px. */
    EXPECT_NEAR(found.blur_step, 2.54, 0.15);
    ASSERT_EQ(found.light.planes.size(), 6u);
    for (const PlaneLight &plane : found.light.planes) {
        EXPECT_NEAR(plane.gain, 1.0, 0.002);
        EXPECT_NEAR(plane.vignetting, 0.05, 0.01);
    }
    ASSERT_TRUE(found.noise.is_known);
    /* Three colours have noise of their own, which gray mixes; both are rounded. */
    const double mixed = 0.299 * 0.299 + 0.587 * 0.587 + 0.114 * 0.114, rounding = 1.0 / 12.0;
    EXPECT_NEAR(found.noise.slope, mixed * 0.2, 0.01);
    EXPECT_NEAR(found.noise.offset, mixed * (4.0 + rounding) + rounding, 0.5);
    EXPECT_TRUE(seen.bad_pixels.empty());

    const std::string file = testing::TempDir() + "found" + std::to_string(getpid()) + ".yml";
    write_calibration(file, found, rig.board());
    const auto warps = AlignmentCalibration::load(file).alignments({640, 480}, 6);
    EXPECT_NEAR(warps[0].warp.scale(), 1.0 - 0.018, 3e-4);
    unlink(file.c_str());

    const std::vector<std::string> few(rig.poses().begin() + 3, rig.poses().begin() + 6);
    EXPECT_TRUE(check(found, rig.board(), look(few).views).faults.empty());
    EXPECT_FALSE(check(found, rig.board(), look(few, rig.board(), "breathing=0.02 noise=moderate").views)
                     .faults.empty());
}

TEST_F(Rig, a_board_that_cannot_be_used_is_told)
{
    const std::string cut = look({"0.2,0,0.5,20,0,0"}, rig.board(), "noise=moderate").told;
    EXPECT_NE(cut.find("cut off"), std::string::npos) << cut;
    for (const Board &wrong : {Board{8, 6, 20.0}, Board{9, 7, 20.0}, Board{12, 9, 20.0}}) {
        const Seen seen = look({"0,0,0.5,20,0,0"}, wrong, "noise=moderate");
        EXPECT_TRUE(seen.views.empty());
        EXPECT_NE(seen.told.find("another number of squares"), std::string::npos) << seen.told;
    }
    const std::string blurred = look({"0,0,0.33,0,0,0"}, rig.board(), "near=0.9 far=0.7 blur-step=4").told;
    EXPECT_TRUE(blurred.find("blurred") != std::string::npos ||
                blurred.find("range that the sweep") != std::string::npos)
        << blurred;
}

/* A camera that goes on for ever ends no pose. */
TEST_F(Rig, a_board_at_rest_is_measured_while_it_is_seen)
{
    std::string told;
    BoardCollector collector(rig.board(), [&](const std::string &line) { told += line + "\n"; });
    SweepReader reader("lenssweeptestsrc num-buffers=60 planes=6 near=3.4 far=0.7 scene=board board=10x7x20 "
                       "pose=0,0,0.5,20,-15,5");
    while (const auto sweep = reader.next())
        collector.add(*sweep);
    EXPECT_EQ(collector.views().size(), 1u) << told;
    EXPECT_NE(told.find("still to be shown: sharp in plane 0, 1"), std::string::npos) << told;
    const std::string moved = "the board is where it was: move it\n";
    EXPECT_EQ(told.find(moved), told.size() - moved.size()) << told;
    collector.end_source();
    EXPECT_EQ(collector.views().size(), 1u);
}

TEST_F(Rig, frames_that_say_no_plane_are_told)
{
    SweepReader reader("videotestsrc num-buffers=2");
    try {
        reader.next();
        FAIL();
    } catch (const std::runtime_error &error) {
        EXPECT_NE(std::string(error.what()).find("lenssweeptag"), std::string::npos);
    }
    EXPECT_THROW(SweepReader("nosuchelement"), std::runtime_error);
}
