/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstaggregator.h>
#include <span>

namespace dff {

enum class Match { Waiting, Again, Ended, Ready };

/* Whether the first buffers of all pads are of one time. Those whose partner did not come are dropped: Again.
 * Buffers without a time go by their order. */
Match match_inputs(std::span<GstAggregatorPad *const> pads);

} // namespace dff
