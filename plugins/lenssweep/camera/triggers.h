/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "plane_labeller.h"

#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace dff {

/* Triggers that are given to a camera, and which of them its frames are of. start() and stop() are called by
 * one thread, which also takes care of the lens; the rest by any. */
class Triggers {
public:
    virtual ~Triggers() = default;

    /* Begins, where that is in our hands with plane 0. The camera is armed. Throws what lens and lines throw.
     */
    virtual void start() = 0;

    /* Where that is in our hands, no trigger is given any more. */
    virtual void stop() noexcept = 0;

    /* Whether stop() brings the triggers to rest and start() begins with plane 0. */
    virtual bool restartable() const = 0;

    /* Throws if the lens or a line has failed by itself. To be called now and then, by the thread of start().
     */
    void check();

    /* Triggers that were given since the first start(), by the word of who gives them; empty if they are not
     * counted there. */
    virtual std::optional<std::uint64_t> given() const { return std::nullopt; }

    /* Edges of the sync line that were not believed. */
    virtual std::uint64_t wrong_edges() const { return 0; }

    /* Readings of that count which contradict the edges. */
    virtual std::uint64_t wrong_counts() const { return 0; }

    /* What the user should know although labels go on; empty if it was told already. */
    virtual std::string take_complaint() { return {}; }

    FrameVerdict label(const CameraFrame &frame);
    bool lost() const;
    LabelCounts counts() const;

protected:
    Triggers(std::unique_ptr<PlaneLabeller> labeller, std::function<void()> on_error);

    /* In a catch block of a thread: check() throws it. */
    void fail() noexcept;

    mutable std::mutex mutex_; /* guards labeller_, what it reads, and error_; nothing is locked within */
    std::unique_ptr<PlaneLabeller> labeller_;

private:
    std::exception_ptr error_;
    std::function<void()> on_error_;
};

} // namespace dff
