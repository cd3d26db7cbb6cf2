/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/stack_assembler.h"
#include "focalstack/stack_maker.h"

#include <map>
#include <optional>

namespace dff {

/* One stack a sweep. Each frame is copied once, when it comes. */
class SweepStacks : public StackMaker {
public:
    SweepStacks(const GstFocalStackInfo &info, OnMissing on_missing, unsigned allowance,
                MuxStatistics &statistics);

    bool add(const PlaneFrame &frame) override;
    void finish() override;

private:
    void settle();
    void finish_stack(PartialStack &stack, uint64_t present);
    bool fill(PartialStack &stack, uint64_t present) const;

    StackAssembler assembler_;
    std::map<uint64_t, PartialStack> open_; /* by sweep; a handful at most */
    std::optional<PartialStack> last_;      /* with OnMissing::Hold: the last stack that was sent */
};

} // namespace dff
