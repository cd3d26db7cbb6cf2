/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

namespace dff {

/* What a depth map's method has learnt of its stack, for who makes a picture of both: by how many pixels the
 * circle of confusion grows from plane to plane. It goes with the buffer as the custom meta "DffBlurStep". */
void add_blur_step(GstBuffer *depth, float pixels);

/* 0 where the map does not tell. */
float blur_step_of(GstBuffer *depth);

} // namespace dff
