/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

/* What the two files of focalstackalign share: the element in focalstackalign.cpp, what it does with a stack
 * in focalstackalign_transform.cpp. */
#include "focalstack/focalstackalign.h"

#include "common/stack_clock.h"
#include "focalstack/alignment_calibration.h"
#include "focalstack/alignment_statistics.h"
#include "focalstack/bad_pixels.h"
#include "focalstack/focalstackalign_properties.h"
#include "focalstack/partial_stack.h"
#include "focalstack/scene_anchor.h"

#include <optional>

GST_DEBUG_CATEGORY_EXTERN(focalstackalign_debug);
#define GST_CAT_DEFAULT focalstackalign_debug

/* What focalstackalign knows between two buffers. */
struct GstFocalStackAlignState {
    /* Guarded by the sink pad's stream lock. */
    std::optional<dff::StackPool> pool;
    dff::StackClock clock;
    bool told_untrusted = false;
    bool told_blank = false;
    std::optional<dff::AlignmentCalibration> calibration; /* with mode=calibration */
    dff::BadPixels bad_pixels;
    bool tells_place = false; /* somebody downstream averages stacks */
    dff::SceneAnchor anchor;  /* if so */

    /* Guarded by the object's lock. */
    dff::AlignSettings settings;
    dff::AlignmentStatistics statistics;
    GstClockTime latency = 0;
};

struct _GstFocalStackAlign {
    GstBaseTransform parent;
    GstFocalStackAlignState *state;
};

namespace dff {

class ObjectLock {
public:
    explicit ObjectLock(gpointer object) : object_(GST_OBJECT(object)) { GST_OBJECT_LOCK(object_); }
    ~ObjectLock() { GST_OBJECT_UNLOCK(object_); }
    ObjectLock(const ObjectLock &) = delete;
    ObjectLock &operator=(const ObjectLock &) = delete;

private:
    GstObject *object_;
};

} // namespace dff

/* The transform function of GstBaseTransform. */
GstFlowReturn gst_focal_stack_align_transform(GstBaseTransform *base, GstBuffer *input, GstBuffer *output);
