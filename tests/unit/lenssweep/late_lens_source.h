/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

/* Registers the element latelenssrc: a camera whose lens is moved by its property lens-position, in dioptres,
 * as that of libcamerasrc is. Pictures are GRAY8, 96x64.
 *
 * A position that is set is told to the lens `delay` frames later, and the lens goes there with the time
 * constant `lag`, in frames. The property reads what the lens had been told for the last frame that was made,
 * or with `echo` what was set. Without af-mode=manual the lens stands still.
 *
 * Each column of the picture is a thing at another distance, from 0 to 10 dioptres; it has texture as long as
 * the lens is near it, and noise. */
void register_late_lens_source();

/* Where the lens really was for a frame, which is written in its first pixels. */
double true_position(GstBuffer *frame);
