/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "stack_depth.h"

namespace dff {

/* What dffdepth tells of the stacks so far. */
class DepthStatistics {
public:
    /* Counts the stack that `depth` has just computed, or was unable to. */
    void add(const StackDepth &depth, bool known, GstClockTime compute_time);

    /* The property `stats`, under this number. */
    static void install_property(GObjectClass *object_class, guint id);
    GstStructure *to_structure() const;

private:
    guint64 stacks_ = 0;
    guint64 without_depth_ = 0;
    GstClockTime compute_time_ = 0; /* of the last stack, as the rest */
    StageTimes stages_;
    std::optional<float> residual_; /* what the solver left, in parts of the right-hand side */
};

} // namespace dff
