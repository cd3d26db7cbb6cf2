/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweep/swing_check.h"
#include "sharp_blocks.h"

#include <cmath>
#include <gtest/gtest.h>

namespace {

constexpr unsigned planes = 6;

/* A scene, and a lens that is `late` planes behind its labels, both ways. */
class Rig {
public:
    Rig(double late, double noise, double contrast = 100) : late_(late), scene_(planes, contrast, noise) {}

    /* Of each frame of `sweeps` sweeps, but those that `is_lost` says. */
    std::optional<double> run(
        unsigned sweeps, bool (*is_lost)(unsigned) = [](unsigned) { return false; })
    {
        SwingCheck check(planes);
        for (unsigned frame = 0; frame < sweeps * planes; frame++) {
            const unsigned sweep = frame / planes;
            const unsigned place = frame % planes;
            const PlaneLabel label{sweep, sweep % 2 == 0 ? place : planes - 1 - place};
            if (is_lost(frame) || !check.wants(label))
                continue;
            measured_++;
            check.add(label, scene_.seen_at(label.plane + (sweep % 2 == 0 ? -late_ : late_)));
        }
        return check.lag();
    }

    unsigned measured_ = 0;

private:
    double late_;
    SharpBlocks scene_;
};

} // namespace

TEST(SwingCheck, a_lens_in_its_place_raises_no_doubt)
{
    EXPECT_FALSE(Rig(0, 1).run(2000));
    EXPECT_FALSE(Rig(0.03, 1).run(2000));
    EXPECT_FALSE(Rig(0, 0).run(200));
}

TEST(SwingCheck, a_lens_that_is_late_or_early_is_told_and_by_how_much)
{
    for (const double late : {-0.5, -0.2, 0.2, 0.5}) {
        const auto lag = Rig(late, 3).run(200);
        ASSERT_TRUE(lag) << late;
        EXPECT_NEAR(*lag, late, 0.5 * std::abs(late));
    }
}

TEST(SwingCheck, noise_alone_raises_no_doubt)
{
    for (const double contrast : {0.0, 1.0})
        EXPECT_FALSE(Rig(0, 10, contrast).run(20000)) << contrast;
}

TEST(SwingCheck, lost_frames_do_no_harm)
{
    EXPECT_FALSE(Rig(0, 1).run(2000, [](unsigned frame) { return frame % 29 == 0; }));
    EXPECT_TRUE(Rig(0.3, 1).run(2000, [](unsigned frame) { return frame % 29 == 0; }));
}

TEST(SwingCheck, few_frames_are_measured_in_the_long_run)
{
    Rig rig(0, 1);
    rig.run(20000);
    EXPECT_LT(rig.measured_, 20000U * planes / 40);
}
