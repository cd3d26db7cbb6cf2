/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/object_motion.h"

#include "focalstack/in_parallel.h"
#include "focalstack/velocity_refinement.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace dff {

namespace {

constexpr int steps[] = {-2, 2};    /* planes to which flow is computed; SweepFollower takes no fewer */
constexpr double slow = 0.25;       /* pixels of the picture a plane: below it nothing is followed */
constexpr double spread = 12.0;     /* pixels over which velocity is spread, thrice as far where none is */
constexpr float far_weight = 0.02F; /* of the wider spreading */
constexpr int inner = 17;           /* side of the square in which flow must be inside a silhouette */
constexpr float core = 0.8F;        /* part of the planes: inside an object */
constexpr float outline = 0.9F;     /* part of the planes: on its outline, */
constexpr float ramp = 1.5F;        /* which is so many planes soft */
constexpr int margin = 12;          /* pixels around all silhouettes */
constexpr int least_for_flow = 64;  /* the flow needs as many pixels */
constexpr int rim = 8;              /* pixels around an object that its blur may reach */
constexpr int inner_rim = 5;        /* side of what must be inside an object for it to tell the velocity */
constexpr float paint = 128.0F;     /* over the background */

cv::Mat ellipse(int side)
{
    return cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
}

/* The rectangle of all silhouettes, with a margin, and large enough for the flow. */
cv::Rect rectangle_of(const Silhouettes &silhouettes)
{
    if (silhouettes.where.empty())
        return {};
    const cv::Size size = silhouettes.wide.front().size();
    cv::Rect where;
    bool is_any = false;
    for (size_t z = 0; z < silhouettes.wide.size(); z++) {
        where |= cv::boundingRect(silhouettes.wide[z](silhouettes.where));
        is_any = is_any || cv::countNonZero(silhouettes.tight[z](silhouettes.where)) > 0;
    }
    if (!is_any || where.empty())
        return {};
    where += silhouettes.where.tl();
    const auto widen = [](int &first, int &size, int most, int by) {
        const int from = std::max(first - by, 0), to = std::min(first + size + by, most);
        first = from;
        size = to - from;
    };
    widen(where.x, where.width, size.width, std::max(margin, (least_for_flow - where.width + 1) / 2));
    widen(where.y, where.height, size.height, std::max(margin, (least_for_flow - where.height + 1) / 2));
    return where;
}

/* Half the size, the background painted out, blurred: what the flow goes by. */
cv::Mat1b flow_picture(const SmallStack &sweep, const Silhouettes &silhouettes, unsigned z,
                       const cv::Rect &where)
{
    cv::Mat1f luma = sweep.luma(z)(where).clone();
    luma.setTo(paint, silhouettes.wide[z](where) == 0);
    cv::resize(luma, luma, {where.width / 2, where.height / 2}, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(luma, luma, {}, 1.0);
    cv::Mat1b picture;
    luma.convertTo(picture, CV_8U);
    return picture;
}

/* The mean of the flows and how far they lie apart, each divided by its planes, at full size. */
void find_flow(const SmallStack &sweep, const Silhouettes &silhouettes, const cv::Rect &where,
               cv::Mat2f &velocity, cv::Mat1f &apart)
{
    const int middle = static_cast<int>(sweep.planes()) / 2;
    const cv::Mat1b from = flow_picture(sweep, silhouettes, static_cast<unsigned>(middle), where);
    std::vector<cv::Mat2f> flows(std::size(steps));
    in_parallel(flows.size(), [&](unsigned i) {
        const auto z = static_cast<unsigned>(middle + steps[i]);
        const auto flow = cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_FAST);
        flow->setFinestScale(0);
        flow->calc(from, flow_picture(sweep, silhouettes, z, where), flows[i]);
        flows[i] /= steps[i];
    });
    cv::Mat2f mean = cv::Mat2f::zeros(from.size());
    for (const cv::Mat2f &of : flows)
        mean += of / static_cast<double>(flows.size());
    cv::Mat2f difference = cv::abs(flows.front() - mean);
    std::vector<cv::Mat> parts;
    cv::split(difference, parts);
    cv::resize(2.0 * cv::Mat(cv::max(parts[0], parts[1])), apart, where.size());
    cv::split(mean, parts);
    for (cv::Mat &part : parts)
        cv::medianBlur(part, part, 5);
    cv::merge(parts, mean);
    cv::resize(2.0 * mean, velocity, where.size());
}

/* Velocity inside the silhouettes, spread over them and around. */
void spread_velocity(const cv::Mat1b &middle, const cv::Mat1f &apart, cv::Mat2f &velocity)
{
    cv::Mat1f inside;
    cv::Mat1f(middle).copyTo(inside);
    cv::blur(inside, inside, {inner, inner});
    cv::Mat3f weighted(velocity.size());
    for (int y = 0; y < velocity.rows; y++)
        for (int x = 0; x < velocity.cols; x++) {
            const float square = inside(y, x) * inside(y, x), fourth = square * square;
            const float weight =
                middle(y, x) ? fourth * fourth / (1.0F + 4.0F * apart(y, x) * apart(y, x)) : 0.0F;
            const cv::Vec2f &v = velocity(y, x);
            weighted(y, x) = {weight * v[0], weight * v[1], weight};
        }
    cv::Mat near, far;
    in_parallel(2,
                [&](unsigned i) { soften(weighted, i == 0 ? spread : 3.0 * spread, i == 0 ? near : far); });
    for (int y = 0; y < velocity.rows; y++)
        for (int x = 0; x < velocity.cols; x++) {
            const cv::Vec3f sum = near.at<cv::Vec3f>(y, x) + far_weight * far.at<cv::Vec3f>(y, x);
            velocity(y, x) = cv::Vec2f(sum[0], sum[1]) / (sum[2] + 1e-6F);
        }
}

/* In how many planes' silhouettes the path of each pixel lies. */
cv::Mat1f planes_on_path(const Silhouettes &silhouettes, const cv::Rect &where, const cv::Mat2f &velocity)
{
    const auto planes = static_cast<unsigned>(silhouettes.tight.size());
    std::vector<cv::Mat1f> found(planes);
    in_parallel(planes, [&](unsigned z) {
        cv::Mat2f path;
        path_through(velocity, z - middle_of_sweep(planes), path);
        cv::Mat1f silhouette;
        silhouettes.tight[z](where).convertTo(silhouette, CV_32F);
        cv::remap(silhouette, found[z], path, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    });
    cv::Mat1f count = cv::Mat1f::zeros(velocity.size());
    for (const cv::Mat1f &of_plane : found)
        count += of_plane;
    return count;
}

/* Holes of a mask filled. */
void fill_holes(cv::Mat1b &mask)
{
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::drawContours(mask, outlines, -1, cv::Scalar(1), cv::FILLED);
}

/* From the count of planes to how surely a pixel is an object's. */
cv::Mat1f objects_of(cv::Mat1f count, float planes)
{
    cv::Mat1b inside = cv::Mat1b(count >= core * planes) & 1;
    cv::morphologyEx(inside, inside, cv::MORPH_OPEN, ellipse(5));
    cv::morphologyEx(inside, inside, cv::MORPH_CLOSE, ellipse(9));
    fill_holes(inside);
    cv::Mat1b deep, near;
    cv::erode(inside, deep, ellipse(5));
    cv::dilate(inside, near, ellipse(3));
    count.setTo(0.0F, near == 0);
    count.setTo(planes, deep);
    cv::GaussianBlur(count, count, {}, 0.7);
    return cv::Mat1f((count - outline * planes) / ramp + 0.5F);
}

cv::Mat1f speed_of(const cv::Mat2f &velocity)
{
    std::vector<cv::Mat> parts;
    cv::split(velocity, parts);
    cv::Mat1f speed;
    cv::magnitude(parts[0], parts[1], speed);
    return speed;
}

/* Velocity made more exact where anything moves: what stands and differs from the background stays at rest.
 */
void refine_moving(const SmallStack &sweep, const Silhouettes &silhouettes, ObjectMotion &motion)
{
    const cv::Mat1b moves = speed_of(motion.velocity) > slow / sweep.factor();
    const cv::Mat1f count = planes_on_path(silhouettes, motion.where, motion.velocity);
    cv::Mat1b inside = (count >= core * static_cast<float>(sweep.planes())) & moves;
    cv::erode(inside, inside, ellipse(inner_rim));
    cv::Mat2f refined = motion.velocity.clone();
    refine_velocity(sweep, motion.where, inside, refined);
    refined.copyTo(motion.velocity, moves);
}

/* Fills in where objects are, by their velocity; gives their speed. */
cv::Mat1f find_objects(const SmallStack &sweep, const Silhouettes &silhouettes, ObjectMotion &motion)
{
    cv::Mat1f speed = speed_of(motion.velocity);
    cv::Mat1f count = planes_on_path(silhouettes, motion.where, motion.velocity);
    count.setTo(0.0F, speed <= slow / static_cast<float>(sweep.factor()));
    motion.objects = objects_of(count, static_cast<float>(sweep.planes()));
    return speed;
}

/* The same once more where there are objects without texture, whose outlines alone tell how they move. Gives
 * the speed. */
cv::Mat1f follow_plain(const SmallStack &sweep, const StillBackground &background,
                       const StillBackground::Noise &noise, const cv::Mat1f &before, ObjectMotion &motion)
{
    refine_plain_velocity(sweep, background, motion.where, cv::Mat1b(before > 0.5F), noise, motion.velocity);
    cv::Mat1f speed = find_objects(sweep, background.found(), motion);
    refine_plain_outline(sweep, background, motion.where, cv::Mat1b(motion.objects > 0.5F), noise,
                         motion.velocity, motion.objects);
    const cv::Mat1b inside = cv::Mat1b(motion.objects > 0.5F);
    if (cv::countNonZero(inside) > 0)
        motion.rims =
            find_rims(sweep, background, motion.where, inside, motion.velocity, noise, motion.objects);
    else
        motion.objects.setTo(0.0F);
    return speed;
}

/* Where nothing moves, or no object is near. */
cv::Mat1b left_alone(const cv::Mat1f &objects, const cv::Mat1b &slow_pixels)
{
    cv::Mat1b near = cv::Mat1b(objects > 0.0F);
    cv::dilate(near, near, ellipse(2 * rim + 1));
    return (slow_pixels | ~near) & 1;
}

} // namespace

ObjectMotion find_motion(const SmallStack &sweep, const StillBackground &background,
                         const StillBackground::Noise &noise)
{
    const Silhouettes &silhouettes = background.found();
    ObjectMotion motion;
    motion.where = rectangle_of(silhouettes);
    if (motion.where.empty())
        return motion;
    cv::Mat1f apart;
    find_flow(sweep, silhouettes, motion.where, motion.velocity, apart);
    const cv::Mat1b middle = silhouettes.tight[sweep.planes() / 2](motion.where);
    spread_velocity(middle, apart, motion.velocity);
    refine_moving(sweep, silhouettes, motion);

    cv::Mat1f speed = find_objects(sweep, silhouettes, motion);
    cv::Mat1b inside = cv::Mat1b(motion.objects > 0.5F);
    if (cv::countNonZero(inside) > 0) {
        const cv::Mat1f before = motion.objects.clone();
        motion.rims =
            find_rims(sweep, background, motion.where, inside, motion.velocity, noise, motion.objects);
        if (cv::countNonZero(motion.rims.plain > 0.5F) > 0)
            speed = follow_plain(sweep, background, noise, before, motion);
    } else
        motion.objects.setTo(0.0F);
    motion.stands = left_alone(motion.objects, cv::Mat1b(speed < slow / sweep.factor()));
    for (const cv::Mat1b &wide : silhouettes.wide)
        motion.stands &= wide(motion.where);
    cv::dilate(motion.stands, motion.stands, ellipse(5));
    speed.setTo(0.0F, motion.objects <= 0.0F);
    cv::minMaxLoc(speed, nullptr, &motion.farthest);
    return motion;
}

} // namespace dff
