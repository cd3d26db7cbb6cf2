/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/frame_verdict.h"

#include <array>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

namespace dff {

/* Keeps inputs abreast that bring one plane each and run in threads of their own: none gets more than one
 * sweep ahead of another. May be called from any thread. */
class SweepGate {
public:
    /* The others wait for this plane from now on. */
    void open(unsigned plane);

    /* Nobody waits for this plane any more. */
    void close(unsigned plane);
    void close_all();

    /* This plane has come to `sweep`. */
    void arrive(unsigned plane, uint64_t sweep);

    /* Blocks until every open plane has come as far as the sweep before this plane's. False if the gate was
     * shut or the plane closed. */
    bool wait(unsigned plane);

    /* Wakes who waits, and lets nobody wait until let_in(); or one plane, until it is opened again. */
    void shut();
    void shut(unsigned plane);
    void let_in();

    /* Lets nobody through until release(). */
    void hold();
    void release();

private:
    bool all_are_near(uint64_t sweep) const;

    struct Input {
        bool open = false;
        bool shut = false;
        std::optional<uint64_t> sweep;
    };

    std::mutex mutex_; /* a leaf: nothing else is locked while it is held; guards everything below */
    std::condition_variable moved_;
    std::array<Input, longest_stack> inputs_;
    bool shut_ = false;
    bool held_ = false;
};

} // namespace dff
