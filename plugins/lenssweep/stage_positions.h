/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "sweep_properties.h"

#include <vector>

/* Where a microscope's stage stands in each plane, as lenssweeptag is told by positions or step-um. */
struct StagePositions {
    std::vector<gdouble> positions_um; /* replaces step_um unless empty */
    gdouble step_um = 0.0;             /* from plane to plane; 0: not known */

    /* The sweep with as many planes as there are positions. Throws std::invalid_argument, with a message for
     * the user, where these are no sweep, or powers say another number. */
    SweepProperties counted(SweepProperties sweep) const;

    /* Micrometres; NAN if nobody says them. */
    double of(unsigned plane) const;
};
