/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/stack_shape.h"

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

namespace dff {

enum class LightFieldLayout {
    Quilt,      /* views in columns and rows, view 0 at the bottom left, leftmost */
    Rgbd,       /* colour, and depth beside it */
    Lenticular, /* the pixels of a panel under slanted cylindrical lenses */
    Elemental,  /* the pixels of a panel under an array of round lenses */
    Views,      /* views in columns and rows, the leftmost at the top left */
};

/* Where the depth of Rgbd is, seen from its colour. */
enum class DepthSide { Right, Left, Below, Above };

/* Where the red, green and blue subpixel of a pixel are: pixels to the right and up. */
using SubpixelCell = std::array<glm::dvec2, 3>;

/* Which of a panel's cells a pixel is, x from the left and y from the bottom, counted over again where there
 * are fewer cells. As in the calibration files of Looking Glass displays. */
enum class CellPattern { Single, Checkerboard, Rows, ShiftedRows, Columns };

/* A panel under cylindrical lenses. With x, y in 0..1 from its bottom left corner, the subpixel of a pixel
 * that is shifted by (a, b), in 0..1 as well, shows the view v = fract((x + a + tilt (y + b)) pitch -
 * center), v in 0..1. See subpixel_shift(). */
struct LenticularSheet {
    double pitch = 1.0; /* lenses along the panel's width */
    double tilt = 0.0;  /* how far lenses lean over the panel's height, in widths of it */
    double center = 0.0;
    bool invert_view = false;          /* v is 1 - v */
    bool flip_x = false;               /* the picture is mirrored along x */
    bool flip_y = false;               /* and along y */
    bool flip_subpixels = false;       /* blue, green, red from the left */
    std::vector<SubpixelCell> cells{}; /* none: red, green, blue from the left, a third of a pixel each */
    CellPattern pattern = CellPattern::Single;
};

enum class LensGrid { Square, Hexagonal };

/* An array of round lenses before a panel; lengths in its pixels. */
struct LensArray {
    double pitch = 10.0;
    double gap = 0.0; /* between panel and lenses; 0: such that a lens's pixels fan out over the view cone */
    LensGrid grid = LensGrid::Square;
    double rotation = 0.0;          /* of the array, radians, from x towards y (clockwise) */
    glm::dvec2 center = {0.0, 0.0}; /* of one lens, from the panel's middle */
    bool flip = false;              /* each lens's picture turned by half a turn */
};

struct LightFieldParameters {
    LightFieldLayout layout = LightFieldLayout::Quilt;
    unsigned columns = 8;
    unsigned rows = 6;        /* of a quilt or of views */
    double view_aspect = 0.0; /* width by height of a view, which the picture is cropped to; 0: as it is */
    double view_cone = 0.6981317007977318; /* between the outermost views, radians: 40 degrees */
    double zero_parallax =
        0.5;                  /* what stands still from view to view: 0 = the sweep's near end, 1 = its far */
    double depth_gain = 0.15; /* from the sweep's near to its far end, in widths of a view */
    bool invert_depth = false;               /* of rgbd: near is black */
    DepthSide depth_side = DepthSide::Right; /* of rgbd */
    bool fill = true; /* holes behind near things show what is around them, else black */
    LenticularSheet sheet;
    LensArray lenses;
};

struct PictureSize {
    uint32_t width;
    uint32_t height;

    bool operator==(const PictureSize &) const = default;
};

} // namespace dff
