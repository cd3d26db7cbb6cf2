/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <gst/gst.h>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace dff {

/* All planes of a sweep, the nearest first. */
struct Sweep {
    std::vector<cv::Mat1b> planes;
    std::vector<double> powers; /* as the source says them, NAN where it does not */
    std::vector<int> codes;     /* what the lens was told, -1 where that is not known */
};

/* Whole sweeps from a pipeline whose frames say which plane they are. */
class SweepReader {
public:
    /* `source` is a description for gst-launch-1.0 that ends in raw frames. Throws std::runtime_error with a
     * user's text, as next() does. */
    explicit SweepReader(const std::string &source);
    ~SweepReader();
    SweepReader(const SweepReader &) = delete;
    SweepReader &operator=(const SweepReader &) = delete;

    /* The next sweep of which no plane is missing; nothing at the end of the stream. */
    std::optional<Sweep> next();

private:
    struct Unref {
        void operator()(void *object) const { gst_object_unref(object); }
    };

    void take(GstSample *sample);
    void fail_on_error();

    std::unique_ptr<GstElement, Unref> pipeline_;
    std::unique_ptr<GstElement, Unref> sink_;
    Sweep sweep_;
    uint64_t number_ = 0;
    std::size_t seen_ = 0;
};

} // namespace dff
