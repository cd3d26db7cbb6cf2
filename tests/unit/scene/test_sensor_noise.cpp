/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/sensor_noise.h"

#include <gtest/gtest.h>

using dff::SensorNoise;

TEST(SensorNoise, variance_is_gain_times_value_plus_read_squared)
{
    const SensorNoise noise{0.5, 3.0};
    for (const float value : {40.0F, 100.0F, 160.0F}) {
        const cv::Mat3b picture = noise.digitise(cv::Mat3f(400, 400, cv::Vec3f::all(value)), 7);
        cv::Scalar mean;
        cv::Scalar deviation;
        cv::meanStdDev(picture, mean, deviation);
        /* Rounding adds the variance of a uniform step. */
        const double variance = noise.gain * value + noise.read * noise.read + 1.0 / 12.0;
        for (int channel = 0; channel < 3; channel++) {
            EXPECT_NEAR(mean[channel], value, 0.1);
            EXPECT_NEAR(deviation[channel] * deviation[channel] / variance, 1.0, 0.02);
        }
    }
}

TEST(SensorNoise, is_independent_between_pixels_and_channels)
{
    const cv::Mat3b picture = SensorNoise{1.0, 5.0}.digitise(cv::Mat3f(300, 300, cv::Vec3f::all(120.0F)), 1);
    cv::Mat1d values;
    picture.reshape(1).convertTo(values, CV_64F, 1.0, -120.0);
    const double variance = values.dot(values) / static_cast<double>(values.total());
    for (const cv::Point step : {cv::Point(1, 0), cv::Point(3, 0), cv::Point(0, 1)}) {
        const cv::Rect part(0, 0, values.cols - step.x, values.rows - step.y);
        const double product = values(part).clone().dot(values(part + step).clone()) / part.area();
        EXPECT_LT(std::abs(product / variance), 0.02);
    }
}

TEST(SensorNoise, repeats_for_a_seed_and_differs_for_another)
{
    const SensorNoise noise{0.2, 2.0};
    const cv::Mat3f picture(50, 60, cv::Vec3f::all(90.0F));
    EXPECT_EQ(cv::norm(noise.digitise(picture, 5), noise.digitise(picture, 5), cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(noise.digitise(picture, 5), noise.digitise(picture, 6), cv::NORM_INF), 0.0);
}

TEST(SensorNoise, none_only_rounds_and_clips)
{
    const cv::Mat3f picture(1, 1, cv::Vec3f(-3.0F, 99.6F, 300.0F));
    EXPECT_EQ(SensorNoise{}.digitise(picture, 0)(0, 0), cv::Vec3b(0, 100, 255));
}

TEST(SensorNoise, levels_have_names_and_numbers)
{
    EXPECT_EQ(SensorNoise::parse("mild")->gain, 0.05);
    EXPECT_EQ(SensorNoise::parse("strong")->read, 5.0);
    EXPECT_TRUE(SensorNoise::parse("none")->silent());
    EXPECT_EQ(SensorNoise::parse("0.3,1.5")->gain, 0.3);
    EXPECT_EQ(SensorNoise::parse("0.3,1.5")->read, 1.5);
    for (const char *bad : {"", "loud", "1", "1,", ",1", "1,2,3", "-1,2", "1,999", "nan,1", "1, 2"})
        EXPECT_FALSE(SensorNoise::parse(bad)) << bad;
}
