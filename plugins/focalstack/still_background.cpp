/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/still_background.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

/* All in pixels of the small pictures, and in brightnesses of which white has 256. */
constexpr int box = 3;              /* differences are averaged over box x box pixels */
constexpr float sigmas = 3.5F;      /* of that average are noise */
constexpr float certain = 4.0F;     /* so much more is an object */
constexpr float perhaps = 0.5F;     /* so much more is not believed */
constexpr int closed = 7;           /* holes that a silhouette may have */
constexpr int most_sweeps = 16;     /* that the background is the mean of */
constexpr float halts = 2.0F;       /* sweeps that something must stand still to become background */
constexpr float first_halts = 0.7F; /* the same, where no background was known */
constexpr int reach = 31;           /* of an object: what is farther from its silhouettes is not believed */
constexpr double whole = 0.3;       /* part of the picture that moves where the camera does, or at a cut; */
constexpr double still_whole = 0.1; /* the same, where it did so in the sweep before */

cv::Mat square(int side)
{
    return cv::getStructuringElement(cv::MORPH_RECT, {side, side});
}

/* By how much more noise is allowed where the mean of k sweeps is compared. */
std::array<float, 256> factors_of_sweeps()
{
    std::array<float, 256> factors{};
    for (size_t k = 0; k < factors.size(); k++)
        factors[k] =
            sigmas / static_cast<float>(box) * std::sqrt(1.0F + 1.0F / std::max(static_cast<float>(k), 1.0F));
    return factors;
}

/* Adds to `excess` how far |mean over a box of a - b| lies above noise: the largest of the channels. b is
 * the mean of `sweeps`, or of one. */
void add_excess(const cv::Mat1f &a, const cv::Mat1f &b, const std::array<float, 256> &noise,
                const cv::Mat1b *sweeps, bool is_first, cv::Mat1f &excess)
{
    static const std::array<float, 256> of_sweeps = factors_of_sweeps();
    cv::Mat1f mean;
    cv::subtract(a, b, mean);
    cv::blur(mean, mean, {box, box});
    for (int y = 0; y < mean.rows; y++) {
        const float *difference = mean[y], *brightness = b[y];
        const uint8_t *k = sweeps ? (*sweeps)[y] : nullptr;
        float *out = excess[y];
        for (int x = 0; x < mean.cols; x++) {
            const float bound =
                noise[static_cast<size_t>(std::clamp(brightness[x], 0.0F, 255.0F))] * of_sweeps[k ? k[x] : 1];
            const float value = std::fabs(difference[x]) - bound;
            out[x] = is_first ? value : std::max(out[x], value);
        }
    }
}

/* Noise makes a few pixels wide anywhere. */
void keep_what_is_near(Silhouettes &found)
{
    cv::Mat1b near = found.tight.front().clone();
    for (const cv::Mat1b &tight : found.tight)
        near |= tight;
    cv::dilate(near, near, square(2 * reach + 1));
    for (cv::Mat1b &wide : found.wide)
        wide &= near;
}

} // namespace

void StillBackground::begin(const SmallStack &sweep)
{
    planes_.resize(sweep.planes());
    for (unsigned z = 0; z < sweep.planes(); z++) {
        Plane &plane = planes_[z];
        plane.background.clear();
        plane.last.clear();
        for (unsigned i = 0; i < sweep.channels(); i++) {
            plane.background.emplace_back(sweep.picture(z, i).clone());
            plane.last.emplace_back(sweep.picture(z, i).clone());
        }
        plane.sweeps = cv::Mat1b(sweep.size(), uint8_t{1});
        plane.known = cv::Mat1b::zeros(sweep.size());
        plane.steady = cv::Mat1b::zeros(sweep.size());
        plane.same = cv::Mat1f::zeros(sweep.size());
    }
}

void StillBackground::compare(const Plane &plane, const SmallStack &sweep, unsigned z, const Noise &noise,
                              cv::Mat1b &tight, cv::Mat1b &wide)
{
    cv::Mat1f excess(sweep.size());
    for (unsigned i = 0; i < sweep.channels(); i++)
        add_excess(sweep.picture(z, i), plane.background[i], noise[i], &plane.sweeps, i == 0, excess);
    tight = cv::Mat1b(excess > certain) & 1;
    cv::morphologyEx(tight, tight, cv::MORPH_OPEN, square(3));
    cv::morphologyEx(tight, tight, cv::MORPH_CLOSE,
                     cv::getStructuringElement(cv::MORPH_ELLIPSE, {closed, closed}));
    wide = cv::Mat1b(excess > perhaps) & 1;
    cv::morphologyEx(wide, wide, cv::MORPH_OPEN, square(3));
    cv::dilate(tight | wide, wide, square(5));
}

/* As in the sweep before, where the plane is wide. */
void StillBackground::look_for_steady(Plane &plane, const SmallStack &sweep, unsigned z, const Noise &noise,
                                      cv::Mat1b &tight, const cv::Mat1b &wide)
{
    constexpr int around = 4; /* of the square that must be steady, and of the box */
    plane.steady.setTo(0);
    cv::Rect where = cv::boundingRect(wide);
    if (!where.empty()) {
        where = cv::Rect(where.x - around, where.y - around, where.width + 2 * around,
                         where.height + 2 * around) &
                cv::Rect({}, sweep.size());
        cv::Mat1f change(where.size());
        for (unsigned i = 0; i < sweep.channels(); i++)
            add_excess(sweep.picture(z, i)(where), plane.last[i](where), noise[i], nullptr, i == 0, change);
        cv::Mat1b steady = plane.steady(where);
        cv::erode(cv::Mat1b(change <= perhaps) & 1, steady, square(5));
    }
    /* Where no background was ever confirmed, a steady picture is no object. */
    tight &= plane.known | (1 - plane.steady);
    for (unsigned i = 0; i < sweep.channels(); i++)
        sweep.picture(z, i).copyTo(plane.last[i]);
}

/* Sweeps that a place has differed and been steady: the mean of all planes and of the places around. */
cv::Mat1f StillBackground::halted_sweeps(const Silhouettes &found)
{
    cv::Mat1f same = cv::Mat1f::zeros(found.wide.front().size());
    cv::Mat1f differs = cv::Mat1f::zeros(same.size());
    for (size_t z = 0; z < planes_.size(); z++) {
        Plane &plane = planes_[z];
        plane.same += 1.0F;
        plane.same.setTo(0.0F, (found.wide[z] & plane.steady) == 0);
        same += plane.same;
        cv::add(differs, found.wide[z], differs, cv::noArray(), CV_32F);
    }
    cv::blur(same, same, {9, 9});
    cv::blur(differs, differs, {9, 9});
    return same / cv::max(differs, 1e-3);
}

/* What the plane shows becomes background where it does not differ, or has halted. */
void StillBackground::learn(Plane &plane, const SmallStack &sweep, unsigned z, const cv::Mat1f &halt,
                            const cv::Mat1b &wide, cv::Mat1b &held)
{
    std::vector<float> share(static_cast<size_t>(wide.cols));
    for (int y = 0; y < wide.rows; y++) {
        uint8_t *sweeps = plane.sweeps[y], *known = plane.known[y], *keep = held[y];
        const uint8_t *differs = wide[y];
        const float *halted = halt[y];
        for (int x = 0; x < wide.cols; x++) {
            const bool is_new = differs[x] && halted[x] >= (known[x] ? halts : first_halts);
            const bool stays = differs[x] && !is_new;
            keep[x] = stays && known[x];
            sweeps[x] = is_new  ? uint8_t{1}
                        : stays ? sweeps[x]
                                : static_cast<uint8_t>(std::min(sweeps[x] + 1, most_sweeps));
            known[x] = stays ? known[x] : static_cast<uint8_t>(!is_new);
            share[static_cast<size_t>(x)] = stays ? 0.0F : 1.0F / static_cast<float>(sweeps[x]);
        }
        for (unsigned i = 0; i < sweep.channels(); i++) {
            float *background = plane.background[i][y];
            const float *picture = sweep.picture(z, i)[y];
            for (int x = 0; x < wide.cols; x++)
                background[x] += (picture[x] - background[x]) * share[static_cast<size_t>(x)];
        }
    }
}

/* The planes are apart from each other. */
template <typename Work> void for_each_plane(unsigned planes, const Work &work)
{
    cv::parallel_for_(cv::Range(0, static_cast<int>(planes)), [&](const cv::Range &range) {
        for (int z = range.start; z < range.end; z++)
            work(static_cast<unsigned>(z));
    });
}

Silhouettes StillBackground::follow(const SmallStack &sweep, const Noise &noise)
{
    Silhouettes found;
    for (auto *masks : {&found.tight, &found.wide, &found.held, &found.known})
        for (unsigned z = 0; z < sweep.planes(); z++)
            masks->emplace_back(cv::Mat1b::zeros(sweep.size()));
    if (planes_.empty()) {
        begin(sweep);
        was_whole_ = false;
        return found;
    }
    for_each_plane(sweep.planes(),
                   [&](unsigned z) { compare(planes_[z], sweep, z, noise, found.tight[z], found.wide[z]); });
    keep_what_is_near(found);
    for_each_plane(sweep.planes(), [&](unsigned z) {
        look_for_steady(planes_[z], sweep, z, noise, found.tight[z], found.wide[z]);
    });
    cv::Mat1b any = found.wide.front().clone();
    for (const cv::Mat1b &wide : found.wide)
        any |= wide;
    found.moved = static_cast<double>(cv::countNonZero(any)) / static_cast<double>(any.total());
    found.is_whole = found.moved > (was_whole_ ? still_whole : whole);
    was_whole_ = found.is_whole;
    if (found.is_whole) {
        begin(sweep);
        return found;
    }
    const cv::Mat1f halt = halted_sweeps(found);
    for_each_plane(sweep.planes(), [&](unsigned z) {
        learn(planes_[z], sweep, z, halt, found.wide[z], found.held[z]);
        planes_[z].known.copyTo(found.known[z]);
    });
    return found;
}

} // namespace dff
