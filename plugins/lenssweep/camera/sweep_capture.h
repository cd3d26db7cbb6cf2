/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "aravis_camera.h"
#include "camera_frame.h"
#include "camera_setup.h"
#include "camera_stream.h"
#include "capture_poll.h"
#include "link_load.h"
#include "pixel_layout.h"
#include "plane_labeller.h"
#include "trigger_times.h"
#include "triggers.h"

#include "lenssweep/lens/lens.h"
#include "lenssweep/trigger/lines.h"

#include <atomic>
#include <functional>
#include <optional>
#include <string>

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

/* Who hears what a capture does, for a log; by the thread that uses the capture. */
struct CaptureLog {
    std::function<void(const std::string &)> event = [](const std::string &) {}; /* rare ones */
    std::function<void(const CameraFrame &, const FrameVerdict &)> judged = [](auto &, auto &) {};
};

/* A camera behind a swept lens: opens, sets up and starts camera, lens and lines in the order they need, and
 * gives frames their planes. One thread uses it; interrupt() may come from any.
 *
 * That thread waits in next() alone, for all there is: frames, edges of the sync line, what the thread beside
 * it knows of the lens or of the triggers it sends (triggers.h), an interrupt, and times when something is
 * due.
 *
 * Where labels are lost for good, a sequencer that can be stopped is stopped, and started again from rest.
 * Errors are thrown as CameraError, LensError, LineError or std::invalid_argument; then the capture is over.
 */
class SweepCapture {
public:
    /* Opens the camera, the lens and the lines. */
    explicit SweepCapture(const CaptureSettings &settings, CaptureLog log = {});
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
    void interrupt() noexcept;

    CaptureCounts counts() const;

    /* What the user should know although the stream goes on; empty if it was told already. */
    std::string take_complaint();

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
    void prepare_lens();
    void acquire();
    void end_acquisition() noexcept;
    void wait_armed();
    void begin_triggers();
    void begin_anew();
    void rest_triggers();
    void recover();
    void hear_triggers();
    FrameVerdict judge(const CameraBuffer &buffer, const CameraFrame &frame);
    std::optional<CapturedPlane> labelled(CameraBuffer buffer);

    CapturePoll poll_; /* woken by parts of the camera, the stream and the triggers until their ends */
    std::atomic<bool> interrupted_ = false;
    CaptureLog log_;
    CaptureSettings settings_;
    AravisCamera camera_;
    std::unique_ptr<Lens> lens_;
    std::unique_ptr<OutputLine> run_;
    std::unique_ptr<EdgeLine> sync_;

    SweepTiming timing_;
    unsigned buffers_ = 0;
    std::unique_ptr<CameraStream> stream_;
    std::unique_ptr<Triggers> triggers_;
    ExposureClock clock_;
    LabelWatch watch_{settings_.plan.planes()};
    CaptureCounts before_; /* of triggers that are gone */
    std::uint64_t incomplete_ = 0;
    std::uint64_t underruns_ = 0; /* of streams that are gone */
    std::uint64_t restarts_ = 0;
    std::uint64_t unlabelled_ = 0; /* while triggers came to rest, since before_ */
    std::uint64_t sweep_base_ = 0; /* of the labels' sweeps */
    std::uint64_t next_sweep_ = 0; /* the first one no plane had */
    unsigned failures_ = 0;        /* recoveries without a sweep's number of labels between them */
    unsigned labels_ = 0;          /* since the last one */
    std::int64_t last_frame_ns_ = 0;
    std::optional<std::int64_t> quiet_until_ns_; /* then the triggers begin */
};

} // namespace dff
