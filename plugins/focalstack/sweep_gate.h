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

/* How a wait at the gate ended. */
enum class GatePass {
    Through,
    Closed, /* nobody waits for this plane any more, nor for its frame */
    Shut,
};

/* Lets one thread in at a time, and keeps inputs abreast that bring one plane each and run in threads of
 * their own. Every wait can be ended for one plane or for all. May be called from any thread. */
class SweepGate {
public:
    /* The others wait for this plane from now on. Whoever still waits for it has been closed out. */
    void open(unsigned plane);

    /* Nobody waits for this plane any more. */
    void close(unsigned plane);
    void close_all();

    /* This plane has come to `sweep`. */
    void arrive(unsigned plane, uint64_t sweep);

    /* Blocks until nobody else is in and every open plane has come so far that this one is at most `lead`
     * sweeps ahead of it; without `lead` the others' sweeps do not matter. Who comes through leaves again. */
    GatePass enter(unsigned plane, std::optional<uint64_t> lead);
    void leave();

    /* Wakes who waits, and lets nobody wait until let_in(); or one plane, until it is opened again. */
    void shut();
    void shut(unsigned plane);
    void let_in();

    /* Lets nobody through until released as often as it was held. */
    void hold();
    void release();

private:
    bool all_are_near(uint64_t sweep, uint64_t lead) const;

    struct Input {
        bool open = false;
        bool shut = false;
        std::optional<uint64_t> sweep;
        unsigned opened = 0; /* how often */
    };

    std::mutex mutex_; /* a leaf: nothing else is locked while it is held; guards everything below */
    std::condition_variable moved_;
    std::array<Input, longest_stack> inputs_;
    bool shut_ = false;
    unsigned holds_ = 0;
    bool occupied_ = false;
};

} // namespace dff
