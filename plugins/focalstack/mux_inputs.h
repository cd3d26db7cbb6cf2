/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/frame_numbering.h"

#include <gst/video/video.h>

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace dff {

/* What the mux knows of one of its sink pads. Belongs to the pad's streaming thread, but for `ended`. */
struct MuxInput {
    MuxInput(GstPad *sink_pad, std::optional<unsigned> of_plane) : pad(sink_pad), plane(of_plane) { reset(); }
    void reset();

    /* Asked for once. */
    bool is_live();

    GstPad *pad;
    std::optional<unsigned> plane; /* empty: frames of all planes come here */
    bool has_caps;
    GstVideoInfo info;
    GstSegment segment;
    FrameNumbering numbering;
    std::optional<bool> live;
    bool ended; /* guarded by MuxInputs */
};

/* The mux's sink pads: one for all planes, or one for each. May be called from any thread. */
class MuxInputs {
public:
    MuxInput &add(GstPad *pad, std::optional<unsigned> plane);
    void remove(GstPad *pad);

    /* Before streaming. */
    void reset();

    /* Which planes have a linked pad of their own: bit z is plane z. */
    uint64_t linked_planes() const;

    /* Posts an error on `element` and returns false unless one pad for all planes or one for each is linked,
     * the latter without a hole where `planes` is 0. */
    bool make_sense(GstElement *element, unsigned planes) const;

    /* The input's stream begins again, or ends; true if this was the last one that had not ended. */
    void reopen(MuxInput &input);
    bool end(MuxInput &input);

private:
    bool all_in_one_linked() const;

    mutable std::mutex mutex_; /* a leaf: nothing else is locked while it is held */
    std::vector<std::unique_ptr<MuxInput>> inputs_;
};

} // namespace dff
