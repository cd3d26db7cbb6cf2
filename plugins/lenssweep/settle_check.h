/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

/* Looks whether labelled frames saw the lens at rest. Now and then the lens is held where it is after a frame
 * was labelled, for longer than a camera is late. If the lens was at rest then the sharpness of the held
 * frames is that of the labelled one, up to noise and what moves in the picture, neither of which knows where
 * the lens came from. If it was not, the sharpness went on along the way from the plane before.
 *
 * Sharpness is what block_sharpness() says of a picture, from frame to frame of one length. */
class SettleCheck {
public:
    using Sharpness = std::vector<double>;

    /* Frames of a held plane after the labelled one. */
    static constexpr unsigned held_frames = 8;

    explicit SettleCheck(unsigned planes) : planes_(planes) {}

    /* Whether the sharpness of the next labelled frame is needed. */
    bool needs_next() const { return labelled_ + 1 >= check_at_; }

    /* The frame was labelled; `sharpness` is empty if it is not needed, or not known. Whether the lens is to
     * be held now. */
    bool add_labelled(Sharpness sharpness);

    /* A frame of the held plane, `k` frames after the labelled one. */
    void add_held(unsigned k, Sharpness sharpness);

    /* Of the change in sharpness from one label to the next plane at rest, the part that came after the
     * label: more for a lens that is later, though not in proportion. Nothing while that is not sure, or next
     * to nothing. */
    std::optional<double> lag() const;

private:
    void set_next_check();

    unsigned planes_;
    uint64_t labelled_ = 0;
    uint64_t check_at_ = 1; /* count of labelled frames before the one to be held */

    Sharpness before_; /* of the frame labelled before the last one */
    Sharpness last_;   /* of the one labelled last */
    Sharpness held_;   /* of the last held frame but one; the last one has noise of its own */

    /* One of each a check: the change after the label along the step, and the step by itself. */
    std::vector<double> changes_;
    std::vector<double> steps_;
};
