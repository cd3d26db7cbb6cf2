/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/rolling_window.h"
#include "focalstack/stack_maker.h"

#include <optional>

namespace dff {

/* A stack at every frame, from the newest frame of each plane. The frame is copied into a window of its own,
 * and the whole window into the stack: a stack's planes must lie in one memory nobody changes, so each stack
 * costs planes + 1 copies of a frame. */
class RollingStacks : public StackMaker {
public:
    RollingStacks(const GstFocalStackInfo &info, OnMissing on_missing, MuxStatistics &statistics);

    bool add(const PlaneFrame &frame) override;
    void finish() override;

private:
    bool send_window();

    RollingWindow rolling_;
    std::optional<PartialStack> window_;
};

} // namespace dff
