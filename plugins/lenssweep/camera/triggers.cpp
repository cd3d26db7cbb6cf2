/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "triggers.h"

#include <utility>

namespace dff {

Triggers::Triggers(std::unique_ptr<PlaneLabeller> labeller, std::function<void()> on_error)
    : labeller_(std::move(labeller)), on_error_(std::move(on_error))
{
}

void Triggers::check()
{
    std::exception_ptr error;
    {
        const std::lock_guard lock(mutex_);
        error = std::exchange(error_, nullptr);
    }
    if (error)
        std::rethrow_exception(error);
}

FrameVerdict Triggers::label(const CameraFrame &frame)
{
    const std::lock_guard lock(mutex_);
    return labeller_->label(frame);
}

bool Triggers::lost() const
{
    const std::lock_guard lock(mutex_);
    return labeller_->lost();
}

LabelCounts Triggers::counts() const
{
    const std::lock_guard lock(mutex_);
    return labeller_->counts();
}

void Triggers::fail() noexcept
{
    {
        const std::lock_guard lock(mutex_);
        error_ = std::current_exception();
    }
    on_error_();
}

} // namespace dff
