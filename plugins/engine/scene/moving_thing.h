/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace dff {

/* What can fly before the scene; bits, so that there may be several. */
enum class MovingKind : unsigned {
    Ball = 1,     /* textured, to the right */
    Crossing = 2, /* a ball behind it that comes the other way and is covered by it for a while */
    Turning = 4,  /* a chequered block that turns about the line of sight while it flies */
    Nearing = 8,  /* a ball that comes nearer while it flies, then goes away again */
    Plain = 16,   /* a disk of one colour, without texture */
};

/* Where a thing is at one time. */
struct MovingPose {
    cv::Point2d center;
    double angle; /* radians, from x to y */
    double scale;
    double depth; /* within the sweep, 0 near to 1 far */
};

/* A thing that flies from side to side, facing the camera. */
class MovingThing {
public:
    /* In a picture of this size, with `speed` pixels from one plane to the next (negative: begins on the
     * right). Time is in planes since the start of the first sweep. */
    MovingThing(MovingKind kind, cv::Size picture, double speed, uint64_t seed);

    MovingPose pose(double time) const;

    /* What of the scene lies nearer than this passes before the thing, the rest behind it. */
    double layer() const;
    double nearest_depth() const;
    double farthest_depth() const;

    /* From its centre to what is farthest off. */
    double reach(double scale = 1.0) const;

    /* Where it is in this pose. */
    bool covers(const cv::Point2d &point, const MovingPose &pose) const;

    /* Of the part of it that is at `point`, pixels a plane. */
    cv::Vec2d velocity(const cv::Point2d &point, double time) const;

    /* What it covers of a part of the picture, premultiplied R, G, B and alpha in 0..1: sharp, after `warp`.
     */
    cv::Mat4f draw(double time, const cv::Matx23d &warp, const cv::Rect &where) const;

private:
    MovingKind kind_;
    cv::Size picture_;
    double speed_;
    double radius_; /* or half the side of a block */
    cv::Mat4f sprite_;
};

/* The things of these MovingKind bits, the farthest layer first. */
std::vector<MovingThing> make_moving_things(unsigned kinds, cv::Size picture, double speed, uint64_t seed);

} // namespace dff
