/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

/* By how many nanoseconds CLOCK_MONOTONIC, which the kernel stamps edges and packets with, is ahead of a
 * clock. They cannot be read at once, and whoever reads them may be kept waiting in between: it is read
 * between two readings of the clock, and of a few attempts that one counts where these lie closest. */
GstClockTimeDiff monotonic_lead(GstClock *clock);
