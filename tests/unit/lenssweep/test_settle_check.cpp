/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweep/block_sharpness.h"
#include "lenssweep/settle_check.h"
#include "sharp_blocks.h"

#include <cmath>
#include <gtest/gtest.h>

namespace {

constexpr unsigned planes = 6;

/* A scene, and a lens that is `late` of a plane behind when frames are labelled. */
class Rig {
public:
    Rig(double late, double noise, double contrast = 100) : late_(late), scene_(planes, contrast, noise) {}

    /* Labels `frames` frames, and holds the lens as it is asked to. */
    std::optional<double> run(unsigned frames)
    {
        SettleCheck check(planes);
        double before = 0;
        for (unsigned frame = 0; frame < frames; frame++) {
            const double plane = frame % planes;
            const double seen = plane - late_ * (plane - before);
            before = plane;
            if (!check.add_labelled(check.needs_next() ? scene_.seen_at(seen) : SettleCheck::Sharpness{}))
                continue;
            holds_++;
            for (unsigned k = 1; k <= SettleCheck::held_frames; k++)
                check.add_held(k, scene_.seen_at(plane));
        }
        return check.lag();
    }

    unsigned holds_ = 0;

private:
    double late_;
    SharpBlocks scene_;
};

} // namespace

TEST(SettleCheck, a_lens_at_rest_raises_no_doubt)
{
    EXPECT_FALSE(Rig(0, 1).run(2000));
    EXPECT_FALSE(Rig(0.02, 1).run(2000));
}

TEST(SettleCheck, a_lens_that_is_late_is_told_and_more_of_one_that_is_later)
{
    double before = 0;
    for (const double late : {0.2, 0.5, 1.0}) {
        const auto lag = Rig(late, 3).run(500);
        ASSERT_TRUE(lag) << late;
        EXPECT_GT(*lag, before);
        EXPECT_LE(*lag, late);
        before = *lag;
    }
}

TEST(SettleCheck, noise_alone_raises_no_doubt)
{
    for (const double contrast : {0.0, 1.0})
        EXPECT_FALSE(Rig(0, 10, contrast).run(20000)) << contrast;
}

TEST(SettleCheck, the_lens_is_held_often_at_first_and_seldom_then)
{
    Rig quick(0, 1);
    quick.run(24 * (1 + 2 * planes));
    EXPECT_EQ(quick.holds_, 24U);
    Rig slow(0, 1);
    slow.run(24 * (1 + 2 * planes) + 10 * (1 + 50 * planes));
    EXPECT_EQ(slow.holds_, 34U);
}

TEST(SettleCheck, the_lens_is_not_held_for_pictures_that_cannot_be_measured)
{
    SettleCheck check(planes);
    for (unsigned frame = 0; frame < 1000; frame++)
        EXPECT_FALSE(check.add_labelled({}));
    EXPECT_FALSE(check.lag());
}

TEST(BlockSharpness, each_block_has_its_own)
{
    constexpr unsigned side = 16 * 8;
    std::vector<uint8_t> pixels(side * side * 2, 0);
    /* stripes of two in the block of row 3, column 5; every second byte is another component */
    for (unsigned y = 24; y < 32; y++)
        for (unsigned x = 40; x < 48; x++)
            pixels[(y * side + x) * 2] = x / 2 % 2 ? 10 : 0;
    const auto sharpness = block_sharpness({pixels.data(), side, side, side * 2, 2});
    ASSERT_EQ(sharpness.size(), 256U);
    for (size_t block = 0; block < 256; block++)
        EXPECT_DOUBLE_EQ(sharpness[block], block == 3 * 16 + 5 ? 100.0 : 0.0) << block;
}

TEST(BlockSharpness, tiny_pictures_have_none)
{
    const std::vector<uint8_t> pixels(40 * 40);
    EXPECT_TRUE(block_sharpness({pixels.data(), 40, 40, 40, 1}).empty());
}
