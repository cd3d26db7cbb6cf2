/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* Pictures of today's largest cameras and of the largest size there is, whole: run by hand (meson test
 * --suite large --setup large), where 16 GiB are to spare. */
#include "two_halves.h"

#include <gtest/gtest.h>

using namespace dff;

class LargePictures : public testing::TestWithParam<StackShape> {};

TEST_P(LargePictures, have_two_halves)
{
    expect_two_halves(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Engine, LargePictures,
                         testing::Values(StackShape{PixelFormat::Rgb, 8256, 5504, 4},
                                         StackShape{PixelFormat::Rgba64, 9504, 6336, 3},
                                         StackShape{PixelFormat::Gray8, 16384, 16384, 2}));
