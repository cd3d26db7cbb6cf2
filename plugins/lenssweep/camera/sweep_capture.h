/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "aravis_camera.h"
#include "camera_stream.h"
#include "capture_settings.h"
#include "exposure_clock.h"
#include "link_load.h"
#include "pixel_layout.h"
#include "sweep_timing.h"
#include "triggers.h"

#include "lenssweep/lens/lens.h"
#include "lenssweep/trigger/lines.h"

#include <optional>

namespace dff {

/* What a stream of planes has been through since its start. */
struct CaptureCounts {
    LabelCounts labels;
    std::uint64_t incomplete = 0;  /* frames of which packets are missing; counted as lost as well */
    std::uint64_t underruns = 0;   /* frames for which no buffer was free; likewise */
    std::uint64_t wrong_edges = 0; /* of the sync line */
    std::uint64_t triggers = 0; /* as the lens's sequencer counts them, each sweep or second and at the end */
    std::uint64_t wrong_counts = 0; /* readings of that count which contradict the sync line */
    std::uint64_t restarts = 0;     /* of the sequencer, since planes could not be told any more */
};

/* A frame whose plane is known. */
struct CapturedPlane {
    CameraBuffer buffer;
    CameraFrame frame;
    std::uint64_t sweep;
    unsigned plane;
    std::int64_t exposed_ns; /* start of its exposure, by the host's CLOCK_MONOTONIC */
};

/* A camera behind a swept lens: opens, sets up and starts camera, lens and lines in the order they need, and
 * gives frames their planes. One thread uses it; interrupt() may come from any.
 *
 * Where labels are lost for good, a sequencer that can be stopped is stopped, and started again from rest.
 * Errors are thrown as CameraError, LensError, LineError or std::invalid_argument; then the capture is over.
 */
class SweepCapture {
public:
    /* Opens the camera, the lens and the lines. */
    explicit SweepCapture(const CaptureSettings &settings);
    ~SweepCapture();
    SweepCapture(const SweepCapture &) = delete;
    SweepCapture &operator=(const SweepCapture &) = delete;

    AravisCamera &camera() { return camera_; }
    const SweepPlan &plan() const { return settings_.plan; }

    /* Takes pictures of this size from now on: the lens is programmed, the camera acquires, and then the
     * triggers begin. Stops what ran before. */
    void start(const PixelLayout &layout, int width, int height);
    void stop() noexcept;

    /* Takes rate, exposure and gain over while it runs. */
    void change(const CaptureSettings &settings);

    /* The next plane, or nothing after interrupt(), at `deadline_ns` of the host's CLOCK_MONOTONIC, and for a
     * frame that has no label. */
    std::optional<CapturedPlane> next(std::int64_t deadline_ns);
    void interrupt();

    CaptureCounts counts() const;

    /* What the user should know although planes go on; empty if it was told already. */
    std::string take_complaint() { return triggers_ ? triggers_->take_complaint() : std::string(); }

    /* From the start of an exposure to the arrival of the frame, at the most that labels can be told at. */
    std::int64_t latency_ns() const { return timing_.exposure_ns + timing_.transfer_ns + timing_.period_ns; }
    unsigned buffers() const { return buffers_; }
    LinkLoad load();
    int code(unsigned plane) const { return lens_->code(plane); }
    bool calibrated() const { return lens_->calibrated(); }

    /* When the last frame of any kind came, or the triggers began. */
    std::int64_t last_frame_ns() const { return last_frame_ns_; }

private:
    void set_timing();
    void make_triggers();
    void acquire();
    void end_acquisition() noexcept;
    void wait_armed();
    void begin_triggers();
    void begin_anew();
    void recover();
    std::optional<CapturedPlane> labelled(CameraBuffer buffer);

    CaptureSettings settings_;
    AravisCamera camera_;
    std::unique_ptr<Lens> lens_;
    std::unique_ptr<OutputLine> run_;
    std::unique_ptr<EdgeLine> sync_;

    SweepTiming timing_;
    unsigned buffers_ = 0;
    std::mutex
        stream_mutex_; /* guards the pointer stream_ against interrupt(); nothing is locked before it */
    std::unique_ptr<CameraStream> stream_;
    std::unique_ptr<Triggers> triggers_;
    ExposureClock clock_;
    CaptureCounts before_; /* of triggers that are gone */
    std::uint64_t incomplete_ = 0;
    std::uint64_t underruns_ = 0; /* of streams that are gone */
    std::uint64_t restarts_ = 0;
    std::uint64_t unlabelled_ = 0; /* while triggers came to rest, since before_ */
    std::uint64_t sweep_base_ = 0; /* of the labels' sweeps */
    std::uint64_t next_sweep_ = 0; /* the first one no plane had */
    unsigned failures_ = 0;        /* recoveries without one label since */
    std::int64_t last_frame_ns_ = 0;
    std::int64_t next_check_ns_ = 0;
    std::optional<std::int64_t> quiet_until_ns_; /* then the triggers begin */
};

} // namespace dff
