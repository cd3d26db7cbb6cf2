/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/small_stack.h"

namespace dff {

/* Velocity of objects, from plane to plane, made more exact by all planes of the sweep: one step of Lucas and
 * Kanade (1981) between planes two apart, each seen where the velocity says, pooled over the object. What is
 * off by a tenth of a pixel a plane is off by half a pixel at the sweep's ends.
 *
 * `where` is a part of the small pictures, of which all that follow are. `inside` are pixels whose paths lie
 * well within an object in all planes: where there are none the velocity stays. */
void refine_velocity(const SmallStack &sweep, const cv::Rect &where, const cv::Mat1b &inside,
                     cv::Mat2f &velocity);

/* How far `pictures` say that velocity is off, of an object that they show where it is in the middle of the
 * sweep, a plane each: one step for all pixels by their `weight`, or none if it is longer than `longest`. */
cv::Vec2f velocity_error(const std::vector<cv::Mat1f> &pictures, const cv::Mat1f &weight, float longest);

/* Where each pixel's object is, so many planes after the middle of the sweep. */
void path_through(const cv::Mat2f &velocity, double planes, cv::Mat2f &path);

/* About a Gaussian, at a cost that does not grow with sigma. */
void soften(const cv::Mat &from, double sigma, cv::Mat &to);

} // namespace dff
