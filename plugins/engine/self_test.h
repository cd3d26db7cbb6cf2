/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/depth_parameters.h"
#include "engine/opencl/device.h"

#include <cstdint>
#include <span>
#include <vector>

namespace dff::self_test {

/* A small stack that every driver must make the same depth of: a texture on a slope, blurred with the
 * distance from the plane it is sharp in. Its grid has one of the numbers of rows that PoCL 7.1 once was
 * wrong at. */
inline constexpr StackShape shape{PixelFormat::I420, 272, 256, 6};

/* Of planes of luma and of colours. */
std::vector<std::byte> stack(const StackShape &shape = self_test::shape);

/* Where a pixel is sharpest, in planes. */
float truth(const StackShape &shape, unsigned x, unsigned y);

/* Depth at every place that is compared, in parts of 255 of the sweep; 8 pixels apart, all lanes of a vector
 * by turns. */
struct Place {
    unsigned x, y;
};
std::vector<Place> places();
std::vector<uint8_t> depth_on(const std::shared_ptr<Device> &device, Method method);

/* What depth_on() gives where the kernels do what they should. */
std::span<const uint8_t> stored(Method method);

/* By what share of the places they differ by more than a fiftieth of the sweep. */
double difference(std::span<const uint8_t> a, std::span<const uint8_t> b);

/* Above this the driver computes wrong. */
inline constexpr double largest_difference = 0.02;

/* Whether the device, with the kernels of its style, computes both methods as stored. False too where its
 * driver fails. */
bool passes(const std::shared_ptr<Device> &device);

} // namespace dff::self_test
