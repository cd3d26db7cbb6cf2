/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lenssweep/camera/camera_frame.h"
#include "lenssweep/camera/plane_labeller.h"
#include "lenssweep/camera/trigger_times.h"

#include <cstdint>
#include <random>
#include <vector>

/* How often what goes wrong, 0 to 1. */
struct Faults {
    double ignored = 0;      /* the camera does not see a trigger */
    double lost = 0;         /* a frame has a number and never comes */
    double doubled = 0;      /* a frame comes twice */
    double late = 0;         /* a frame comes up to three periods late, perhaps after its successors */
    double edge_lost = 0;    /* a sync edge is not seen */
    double edge_doubled = 0; /* is seen twice */
    double edge_late = 0;    /* is heard of up to three periods late */
    double edge_wrong = 0;   /* comes where there is none */
    double edges_off = 0;    /* all edges of up to eight sweeps come at another plane */
    double clock_jump = 0;   /* the camera's clock is set, before a trigger, up to three periods off */
    double pause = 0;        /* the triggers rest for up to two seconds after one */
    double lag = 0;          /* all frames of up to eight sweeps are up to six periods late */
};

/* A sequencer and a camera of the laboratory. */
struct Rig {
    dff::SweepTiming timing;
    dff::FrameNumbering numbering = dff::FrameNumbering::GigE16;
    std::uint64_t last_id = 0; /* the camera's last number */
    bool has_clock = true;
    double drift_ppm = 0;             /* of the camera's clock */
    std::int64_t clock_offset_ns = 0; /* and where it stands */
    std::int64_t transfer_ns = 0; /* from the end of an exposure to the arrival, beside the link's share */
    std::int64_t lag_ns = 0;      /* and while frames lag */
    std::int64_t jitter_ns = 0;   /* of arrivals */
    std::int64_t edge_off_ns = 0; /* what edges are late by, while they are off */
    std::vector<std::int64_t> triggers_ns; /* all that were given */
    Faults faults;
};

/* What the host sees, and what only the laboratory knows. */
struct RigEvent {
    enum Kind { Edge, Frame } kind;
    std::int64_t seen_ns;
    std::int64_t time_ns; /* of an edge */
    dff::CameraFrame frame;
    std::uint64_t sweep; /* of a frame, truly */
    unsigned plane;
};

/* Triggers of so many sweeps from rest at `begin_ns`, as the host sees them, in order; `first_sweep` is the
 * true number of the first one. Goes on with the camera's numbers. */
std::vector<RigEvent> play(Rig &rig, std::int64_t begin_ns, std::uint64_t first_sweep, unsigned sweeps,
                           std::mt19937_64 &random);
