/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/mux_statistics.h"

#include <string>

namespace dff {

/* Notices when frames come and no stacks, and says why: once for each cause. */
class StackWatch {
public:
    /* Sweeps of frames that may pass without a stack: a stream that starts or a source that numbers its
     * sweeps anew needs some. */
    static constexpr unsigned patience_sweeps = 16;

    /* To be called after every frame; mostly empty. */
    std::string look(const MuxStatistics &counts, unsigned planes);

private:
    enum Cause : unsigned { Damaged = 1, Repeated = 2, Late = 4, Missing = 8 };

    Cause cause(const MuxStatistics &counts) const;

    MuxStatistics at_last_stack_;
    unsigned told_ = 0; /* causes */
};

} // namespace dff
