/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "frame_numbers.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace dff {

/* What is known of a frame beside its pixels. */
struct CameraFrame {
    std::uint64_t id = 0;        /* the camera's number */
    std::int64_t camera_ns = 0;  /* of the camera's own clock; 0: it has none */
    std::int64_t arrival_ns = 0; /* when its last byte was here, by the host's CLOCK_MONOTONIC */

    /* The best that says when it was exposed, up to a constant. */
    std::int64_t stamp_ns() const { return camera_ns != 0 ? camera_ns : arrival_ns; }
};

struct FrameLabel {
    std::uint64_t sweep;
    unsigned plane;
    std::optional<std::int64_t> trigger_ns; /* of the host's CLOCK_MONOTONIC, where triggers are seen */
};

/* Why a frame has no label. */
enum class Unlabelled {
    Seeking,   /* not yet known which trigger is which frame's */
    Invalid,   /* the camera cannot have given this number */
    Doubled,   /* it was here already */
    NoTrigger, /* no trigger is known that it could be of: the edge of its sweep is missing or late */
    Disagree,  /* its number, its time and the triggers do not agree, or did not before in this sweep */
    Incomplete /* packets of it are missing */
};
constexpr std::size_t unlabelled_reasons = 6;

/* For a log. */
const char *name_of(Unlabelled reason);

struct FrameVerdict {
    std::optional<FrameLabel> label;
    Unlabelled reason = Unlabelled::Seeking; /* if there is no label */
};

struct LabelCounts {
    std::uint64_t labelled = 0;
    std::uint64_t unlabelled = 0;
    std::uint64_t lost = 0;    /* numbers that never came */
    std::uint64_t doubled = 0; /* frames that came twice */
    std::uint64_t disagreements =
        0; /* frames at odds with the triggers: one that the camera missed, mostly */
    std::uint64_t dropped_sweeps = 0; /* sweeps in which not every frame that came has a label */
};

/* Tells which plane of which sweep a frame is, and no label rather than one that may be wrong. */
class PlaneLabeller {
public:
    virtual ~PlaneLabeller() = default;

    /* How the triggers begin. FromRest: none is given before `host_ns`, and the first one is plane 0. */
    enum class Beginning { FromRest, UnderWay };

    /* Forgets how frames and triggers go together. */
    virtual void start(Beginning beginning, std::int64_t host_ns) = 0;

    /* Frames in the order they come. */
    virtual FrameVerdict label(const CameraFrame &frame) = 0;

    /* Whether no label will come any more unless the triggers are stopped and start() is called. */
    virtual bool lost() const = 0;

    virtual const LabelCounts &counts() const = 0;
};

} // namespace dff
