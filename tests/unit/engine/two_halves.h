/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/stack_shape.h"

namespace dff {

/* Expects the right depth and picture, by every blend, of a stack without subsampling whose left half is
 * sharp in the nearest plane and the right half in the farthest. */
void expect_two_halves(const StackShape &shape);

} // namespace dff
