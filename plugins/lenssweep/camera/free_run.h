/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "counting_labeller.h"
#include "triggers.h"

namespace dff {

/* A camera that triggers itself: its frames are counted, and nothing moves in step. */
class FreeRun : public Triggers {
public:
    FreeRun(const SweepTiming &timing, FrameNumbers numbers)
        : Triggers(std::make_unique<CountingLabeller>(timing, numbers, CountingLabeller::Counts::FreeRun),
                   [] {})
    {
    }

    void start() override
    {
        const std::lock_guard lock(mutex_);
        labeller_->start(PlaneLabeller::Beginning::UnderWay, 0);
    }
    void stop() noexcept override {}
    bool restartable() const override { return false; }
};

} // namespace dff
