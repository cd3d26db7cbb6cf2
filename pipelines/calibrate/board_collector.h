/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "board_view.h"
#include "pixel_watch.h"

#include <functional>

namespace dff {

/* Takes sweeps as they come and keeps a view of each pose of the board, of the mean of the sweeps that show
 * it. */
class BoardCollector {
public:
    using Tell = std::function<void(const std::string &)>; /* a line for the user */

    BoardCollector(const Board &board, Tell tell) : board_(board), tell_(std::move(tell)) {}

    void add(const Sweep &sweep);
    /* The camera or the file ends; what comes next is another pose. */
    void end_source();

    const std::vector<BoardView> &views() const { return views_; }
    std::vector<cv::Point> bad_pixels() const { return pixels_.bad_pixels(); }

private:
    void keep();
    bool is_known(const BoardView &view) const;
    void tell_once(const std::string &line);

    Board board_;
    Tell tell_;
    std::vector<BoardView> views_;
    std::vector<Sweep> resting_; /* of one pose */
    std::optional<BoardView> pose_;
    std::string last_told_;
    PixelWatch pixels_;
};

} // namespace dff
