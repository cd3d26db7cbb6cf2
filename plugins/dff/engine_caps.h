/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff.h>

/* The engine's kernels work on rows of 64 pixels or more, and are tried up to 8192. */
#define ENGINE_SIZES "width = (int) [ 64, 8192 ], height = (int) [ 64, 8192 ]"
#define ENGINE_STACK_CAPS                                                                                    \
    GST_FOCAL_STACK_CAPS_NAME                                                                                \
    ", format = (string) " GST_FOCAL_STACK_FORMATS ", " ENGINE_SIZES                                         \
    ", planes = (int) [ 2, 64 ], framerate = (fraction) [ 0, max ]"
