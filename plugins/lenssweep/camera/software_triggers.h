/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera_control.h"
#include "frame_numbers.h"
#include "sent_triggers.h"
#include "sweep_timing.h"
#include "triggers.h"

#include "lenssweep/lens/lens.h"

#include <thread>

namespace dff {

/* Commands of this host's, one a period or, with a SteppedLens, as soon after it as the lens rests. */
class SoftwareTriggers : public Triggers {
public:
    /* The lens may be null. Both outlive this object. */
    SoftwareTriggers(const SweepTiming &timing, FrameNumbers numbers, CameraControl &camera,
                     SteppedLens *lens, std::function<void()> on_error);
    ~SoftwareTriggers() override;

    void start() override;
    void stop() noexcept override;
    bool restartable() const override { return true; }

private:
    SoftwareTriggers(const SweepTiming &timing, FrameNumbers numbers, CameraControl &camera,
                     SteppedLens *lens, std::unique_ptr<SentTriggers> sent, std::function<void()> on_error);
    void send(const std::stop_token &stop);
    bool settle(unsigned plane, const std::stop_token &stop);

    SweepTiming timing_;
    CameraControl &camera_;
    SteppedLens *lens_;
    std::unique_ptr<SentTriggers> sent_; /* guarded by mutex_ */
    std::int64_t next_sweep_ = -1;       /* of the sending thread, and of start() before it */
    std::jthread sender_;
};

} // namespace dff
