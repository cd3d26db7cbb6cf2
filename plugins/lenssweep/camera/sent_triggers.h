/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "sweep_timing.h"
#include "trigger_times.h"

#include <deque>

namespace dff {

/* The triggers that this host sends itself, one plane after the other. */
class SentTriggers : public TriggerTimes {
public:
    explicit SentTriggers(const SweepTiming &timing) : timing_(timing) {}

    /* A trigger is given now. The index says which. */
    void sent(const Trigger &trigger);

    void restart() override;
    unsigned rhythm() const override { return rhythm_; }
    std::optional<Trigger> first() const override;
    unsigned proofs() const override { return static_cast<unsigned>(triggers_.size()); }
    std::optional<Trigger> nearest(std::int64_t time_ns) const override;
    std::int64_t time_of(std::int64_t index) const override;

private:
    SweepTiming timing_;
    std::deque<Trigger> triggers_; /* in order, the last few */
    unsigned rhythm_ = 0;
};

} // namespace dff
