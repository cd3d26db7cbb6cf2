/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/depth_scale.h"

#include <gst/dff/dff.h>
#include <optional>
#include <stdexcept>

namespace dff {

/* What is known of where a stack's planes lie. */
struct PlanePositions {
    std::vector<double> powers;       /* dioptres, one a plane; empty if not all are known */
    std::vector<double> positions_um; /* stage positions, one a plane; empty if not all are known */

    bool operator==(const PlanePositions &) const = default;
};

/* From the stack's meta; nothing is known of a stack without one. Throws std::invalid_argument with a user's
 * text if the meta cannot be the one of such a stack: gst_focal_stack_info_get_meta(). */
PlanePositions plane_positions(const GstFocalStackInfo &info, GstBuffer *stack);

/* A unit was asked for which needs what nobody said. */
class UnknownPositions : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

/* How to write depth maps in the unit that was asked for. Throws UnknownPositions if the unit needs positions
 * that are not known, and std::invalid_argument if they are not in order, with a user's text. */
DepthEncoder make_encoder(GstDepthUnit unit, unsigned planes, const PlanePositions &positions);

/* How to read a depth map with such a meta, of a stack whose planes lie at `positions`; where these are not
 * known the planes are taken as even in dioptres between the meta's near and far. Throws as make_encoder().
 */
DepthEncoder encoder_of(const GstDepthInfo &depth, unsigned planes, const PlanePositions &positions);

/* The facts of maps that `encoder` writes. */
GstDepthInfo depth_info(const DepthEncoder &encoder, const PlanePositions &positions);

} // namespace dff
