/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace dff {

/* What comes out of the trigger line. */
struct Trigger {
    uint64_t time_ns; /* CLOCK_MONOTONIC, as exact as an FPGA's: our thread may be late */
    uint64_t sweep;
    unsigned plane;
};

struct SequencerSettings {
    unsigned planes = 6;
    double rate = 26.0;             /* sweeps a second */
    std::optional<uint64_t> sweeps; /* it stops after so many; none: never */
    double pause_at = 0.0;          /* seconds after `run` rose it pauses, */
    double pause_for = 0.0;         /* so many seconds */
};

/* The FPGA, simulated: while `run` is high it makes a sawtooth of planes, a trigger pulse for each and a sync
 * pulse with plane 0. */
class Sequencer {
public:
    /* Both are called from the sequencer's thread. */
    struct Outputs {
        std::function<void(const Trigger &)> trigger;
        std::function<void(uint64_t time_ns)> sync;
    };

    Sequencer(const SequencerSettings &settings, Outputs outputs);
    ~Sequencer();
    Sequencer(const Sequencer &) = delete;
    Sequencer &operator=(const Sequencer &) = delete;

    /* The run line: a sweep begins at plane 0 when it rises, and breaks off when it falls. */
    void set_run(bool run);

private:
    void work(const std::stop_token &stop);
    void sweep_while_running(std::unique_lock<std::mutex> &lock, const std::stop_token &stop);
    void pulse(uint64_t count, uint64_t time_ns);

    SequencerSettings settings_;
    Outputs outputs_;
    uint64_t next_sweep_ = 0; /* sweeps are numbered through all runs */
    std::mutex mutex_;        /* guards run_; not held while the outputs are called */
    std::condition_variable_any changed_;
    bool run_ = false;
    std::jthread thread_;
};

} // namespace dff
