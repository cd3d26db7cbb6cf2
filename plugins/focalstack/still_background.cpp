/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/still_background.h"

#include "focalstack/in_parallel.h"
#include "focalstack/noise_excess.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace dff {

namespace {

/* All in pixels of the small pictures, and in brightnesses of which white has 256. */
constexpr float certain = 4.0F;     /* above noise by so much is an object */
constexpr float perhaps = 0.5F;     /* by so much is not believed */
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

cv::Rect widened(const cv::Rect &where, int by, const cv::Size &size)
{
    if (where.empty())
        return {};
    return cv::Rect(where.x - by, where.y - by, where.width + 2 * by, where.height + 2 * by) &
           cv::Rect({}, size);
}

/* What one row shows becomes background, where nothing differs. */
void learn_still(uint8_t *sweeps, uint8_t *known, float *share, int first, int end)
{
    for (int x = first; x < end; x++) {
        sweeps[x] = static_cast<uint8_t>(std::min(sweeps[x] + 1, most_sweeps));
        known[x] = 1;
    }
    for (int x = first; x < end; x++)
        share[x] = 1.0F / static_cast<float>(sweeps[x]);
}

} // namespace

void StillBackground::begin(const SmallStack &sweep)
{
    planes_.resize(sweep.planes());
    for (unsigned z = 0; z < sweep.planes(); z++) {
        Plane &plane = planes_[z];
        plane.background.resize(sweep.channels());
        for (unsigned i = 0; i < sweep.channels(); i++)
            sweep.picture(z, i).copyTo(plane.background[i]);
        plane.sweeps = cv::Mat1b(sweep.size(), uint8_t{1});
        for (cv::Mat1b *mask : {&plane.known, &plane.steady, &plane.raw})
            *mask = cv::Mat1b::zeros(sweep.size());
        plane.same = cv::Mat1f::zeros(sweep.size());
        plane.steady_where = {};
        plane.outline = {};
        found_.known[z] = plane.known;
    }
    last_where_ = {};
}

/* Nothing is set in any mask. */
void StillBackground::clear(const SmallStack &sweep)
{
    for (auto *masks : {&found_.tight, &found_.wide, &found_.held}) {
        masks->resize(sweep.planes());
        for (cv::Mat1b &mask : *masks) {
            if (mask.size() != sweep.size())
                mask = cv::Mat1b::zeros(sweep.size());
            else if (!found_.where.empty())
                mask(found_.where).setTo(0);
        }
    }
    found_.known.resize(sweep.planes());
    found_.where = {};
    found_.moved = 0.0;
    found_.is_whole = false;
}

/* The tight silhouette of a plane, whose pictures are taken and compared while they are in the cache. */
void StillBackground::find_certain(const StackPictureViews &pictures, SmallStack &sweep, unsigned z,
                                   const Noise &noise)
{
    constexpr int band = 32; /* rows */
    Plane &plane = planes_[z];
    const cv::Size size = sweep.size();
    cv::Rect set;
    for (unsigned i = 0; i < sweep.channels(); i++)
        for (int taken = 0, compared = 0; taken < size.height;) {
            const int first = std::exchange(taken, std::min(taken + band, size.height));
            sweep.take(pictures, z, i, {first, taken});
            /* A row is compared with those around it. */
            const int begin = std::exchange(compared, taken < size.height ? taken - 1 : taken);
            set |= mark_excess({sweep.picture(z, i), plane.background[i], noise[i]}, &plane.sweeps, certain,
                               {0, begin, size.width, compared - begin}, plane.raw);
        }
    plane.outline = {};
    if (set.empty())
        return;
    const cv::Rect around = widened(set, closed + 1, sweep.size());
    cv::Mat1b tight = found_.tight[z](around), raw = plane.raw(around);
    cv::morphologyEx(raw, tight, cv::MORPH_OPEN, square(3));
    raw.setTo(0);
    plane.outline = cv::boundingRect(tight);
    if (plane.outline.empty())
        return;
    cv::morphologyEx(tight, tight, cv::MORPH_CLOSE,
                     cv::getStructuringElement(cv::MORPH_ELLIPSE, {closed, closed}));
    plane.outline = cv::boundingRect(tight) + around.tl();
}

/* Of found_.where: what is not too far from any plane's silhouette; noise makes a few pixels wide anywhere.
 */
cv::Mat1b StillBackground::near_objects() const
{
    cv::Mat1b near = found_.tight.front()(found_.where).clone();
    for (const cv::Mat1b &tight : found_.tight)
        near |= tight(found_.where);
    cv::dilate(near, near, square(2 * reach + 1));
    return near;
}

/* The wide silhouette of a plane. */
void StillBackground::find_perhaps(const SmallStack &sweep, unsigned z, const Noise &noise,
                                   const cv::Mat1b &near)
{
    constexpr int around = 4; /* pixels that opening and dilation look at */
    Plane &plane = planes_[z];
    const cv::Rect where = widened(found_.where, around, sweep.size());
    for (unsigned i = 0; i < sweep.channels(); i++)
        mark_excess({sweep.picture(z, i), plane.background[i], noise[i]}, &plane.sweeps, perhaps, where,
                    plane.raw);
    cv::Mat1b wide;
    cv::morphologyEx(plane.raw(where), wide, cv::MORPH_OPEN, square(3));
    plane.raw(where).setTo(0);
    wide |= found_.tight[z](where);
    cv::dilate(wide, wide, square(5));
    found_.wide[z](found_.where) = wide(found_.where - where.tl()) & near;
}

/* As in the sweep before, where the plane is wide. */
void StillBackground::look_for_steady(const SmallStack &sweep, const SmallStack &last, unsigned z,
                                      const Noise &noise)
{
    constexpr int around = 4; /* of the square that must be steady, and of the box */
    Plane &plane = planes_[z];
    if (!plane.steady_where.empty())
        plane.steady(plane.steady_where).setTo(0);
    cv::Rect where = cv::boundingRect(found_.wide[z](found_.where));
    plane.steady_where = where.empty() ? where : widened(where + found_.where.tl(), around, sweep.size());
    if (plane.steady_where.empty())
        return;
    for (unsigned i = 0; i < sweep.channels(); i++)
        mark_excess({sweep.picture(z, i), last.picture(z, i), noise[i]}, nullptr, perhaps, plane.steady_where,
                    plane.raw);
    cv::Mat1b changed = plane.raw(plane.steady_where), steady = plane.steady(plane.steady_where);
    cv::erode(1 - changed, steady, square(5));
    changed.setTo(0);
    /* Where no background was ever confirmed, a steady picture is no object. */
    found_.tight[z](found_.where) &= plane.known(found_.where) | (1 - plane.steady(found_.where));
}

double StillBackground::moved_part() const
{
    if (found_.where.empty())
        return 0.0;
    cv::Mat1b any = found_.wide.front()(found_.where).clone();
    for (const cv::Mat1b &wide : found_.wide)
        any |= wide(found_.where);
    return static_cast<double>(cv::countNonZero(any)) / static_cast<double>(found_.wide.front().total());
}

/* Sweeps that a place has differed and been steady: the mean of all planes and of the places around. */
cv::Mat1f StillBackground::halted_sweeps(const cv::Rect &where, uint64_t absent)
{
    cv::Mat1f same = cv::Mat1f::zeros(where.size());
    cv::Mat1f differs = cv::Mat1f::zeros(where.size());
    for (size_t z = 0; z < planes_.size(); z++) {
        if (absent >> z & 1)
            continue;
        cv::Mat1f of_plane = planes_[z].same(where);
        of_plane += 1.0F;
        of_plane.setTo(0.0F, (found_.wide[z](where) & planes_[z].steady(where)) == 0);
        same += of_plane;
        cv::add(differs, found_.wide[z](where), differs, cv::noArray(), CV_32F);
    }
    cv::blur(same, same, {9, 9});
    cv::blur(differs, differs, {9, 9});
    return same / cv::max(differs, 1e-3);
}

/* What the plane shows becomes background where it does not differ, or has halted. */
void StillBackground::learn(const SmallStack &sweep, unsigned z, const cv::Mat1f &halt,
                            const cv::Rect &halt_where)
{
    Plane &plane = planes_[z];
    const int cols = sweep.size().width;
    std::vector<float> shares(static_cast<size_t>(cols));
    float *share = shares.data();
    for (int y = 0; y < sweep.size().height; y++) {
        uint8_t *sweeps = plane.sweeps[y], *known = plane.known[y];
        const bool is_near = y >= found_.where.y && y < found_.where.y + found_.where.height;
        const int first = is_near ? found_.where.x : cols, end = is_near ? first + found_.where.width : cols;
        learn_still(sweeps, known, share, 0, first);
        learn_still(sweeps, known, share, end, cols);
        for (int x = first; x < end; x++) {
            const bool differs = found_.wide[z](y, x) != 0;
            const float halted = differs ? halt(y - halt_where.y, x - halt_where.x) : 0.0F;
            const bool is_new = differs && halted >= (known[x] ? halts : first_halts);
            const bool stays = differs && !is_new;
            found_.held[z](y, x) = stays && known[x];
            sweeps[x] = is_new  ? uint8_t{1}
                        : stays ? sweeps[x]
                                : static_cast<uint8_t>(std::min(sweeps[x] + 1, most_sweeps));
            known[x] = stays ? known[x] : static_cast<uint8_t>(!is_new);
            share[x] = stays ? 0.0F : 1.0F / static_cast<float>(sweeps[x]);
        }
        for (unsigned i = 0; i < sweep.channels(); i++) {
            float *background = plane.background[i][y];
            const float *picture = sweep.picture(z, i)[y];
            for (int x = 0; x < cols; x++)
                background[x] += (picture[x] - background[x]) * share[x];
        }
    }
    found_.known[z] = plane.known;
}

const Silhouettes &StillBackground::follow(const StackPictureViews &pictures, SmallStack &sweep,
                                           const SmallStack &last, const Noise &noise, uint64_t absent)
{
    const auto each_plane = [&](const auto &work) {
        in_parallel(sweep.planes(), [&](unsigned z) {
            if (!(absent >> z & 1))
                work(z);
        });
    };
    clear(sweep);
    if (planes_.empty() && absent != 0)
        return found_;
    if (planes_.empty()) {
        sweep.take(pictures);
        begin(sweep);
        was_whole_ = false;
        return found_;
    }
    each_plane([&](unsigned z) { find_certain(pictures, sweep, z, noise); });
    for (unsigned z = 0; z < sweep.planes(); z++)
        if (absent >> z & 1)
            sweep.take(last, z);
        else
            found_.where |= planes_[z].outline;
    found_.where = widened(found_.where, reach, sweep.size());
    if (!found_.where.empty()) {
        const cv::Mat1b near = near_objects();
        each_plane([&](unsigned z) {
            find_perhaps(sweep, z, noise, near);
            look_for_steady(sweep, last, z, noise);
        });
    }
    found_.moved = moved_part();
    found_.is_whole = found_.moved > (was_whole_ ? still_whole : whole);
    was_whole_ = found_.is_whole;
    if (found_.is_whole && absent != 0)
        forget();
    else if (found_.is_whole)
        begin(sweep);
    if (found_.is_whole)
        return found_;
    constexpr int around = 4; /* pixels that the mean of halted_sweeps() looks at */
    const cv::Rect halt_where = widened(found_.where | last_where_, around, sweep.size());
    const cv::Mat1f halt = halt_where.empty() ? cv::Mat1f() : halted_sweeps(halt_where, absent);
    each_plane([&](unsigned z) { learn(sweep, z, halt, halt_where); });
    last_where_ = found_.where;
    return found_;
}

} // namespace dff
