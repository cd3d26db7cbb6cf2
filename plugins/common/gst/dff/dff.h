/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/gstdepthmeta.h>
#include <gst/dff/gstdffcapture.h>
#include <gst/dff/gstdffcontext.h>
#include <gst/dff/gstfocalstackinfo.h>
#include <gst/dff/gstfocalstackmeta.h>
#include <gst/dff/gstfocusmeta.h>
