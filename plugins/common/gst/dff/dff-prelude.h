/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

#ifdef BUILDING_GST_DFF
#define GST_DFF_API __attribute__((visibility("default"))) extern
#else
#define GST_DFF_API extern
#endif
