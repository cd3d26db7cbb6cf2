/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <random>
#include <string>

namespace dff {

/* How often something happens: at every n-th frame, at one in n by chance, or never. */
struct Frequency {
    uint64_t one_in = 0; /* 0: never */
    bool by_chance = false;

    /* "100" is every hundredth, "~100" one in a hundred by chance. Throws std::invalid_argument. */
    static Frequency parse(const std::string &text);
};

/* What goes wrong with one trigger or its frame. */
struct Fault {
    bool ignore = false;    /* the camera does not see the trigger: no frame, no frame id */
    bool lose = false;      /* the frame has an id, and is never sent */
    bool duplicate = false; /* sent twice */
    bool hold = false;      /* sent after the frame that follows */
    bool delay = false;     /* sent late */
};

struct FaultSettings {
    Frequency ignore;
    Frequency lose;
    Frequency duplicate;
    Frequency reorder;
    Frequency delay;
    uint64_t delay_ns = 20'000'000;
    uint64_t seed = 0;
};

/* Deals faults out, the same ones for the same seed. */
class FaultPlan {
public:
    explicit FaultPlan(const FaultSettings &settings) : settings_(settings), random_(settings.seed) {}

    /* For the next trigger. */
    Fault next();

    uint64_t delay_ns() const { return settings_.delay_ns; }

private:
    bool due(const Frequency &frequency);

    FaultSettings settings_;
    uint64_t count_ = 0;
    std::mt19937_64 random_;
};

} // namespace dff
