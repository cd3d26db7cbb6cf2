/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <optional>

namespace dff {

/* A buffer's number in its stream and its running time, where it has one. */
struct NumberedTime {
    uint64_t number;
    std::optional<uint64_t> time_ns;
};

/* Tells which depth maps go with which stacks by their numbers. These rise from one to the next, and begin
 * anew in both streams where a source does; of either stream any may be lost. */
class NumberMatching {
public:
    enum class Order { Earlier, Same, Later };

    /* Where the next depth map stands to the next stack. */
    Order order(const NumberedTime &depth, const NumberedTime &stack);

    /* These have gone by. */
    void pass_depth(uint64_t number) { depths_.pass(number); }
    void pass_stack(uint64_t number) { stacks_.pass(number); }

private:
    /* How often a stream's numbers have begun anew. */
    class Restarts {
    public:
        uint64_t until(uint64_t number) const { return restarts_ + (last_ && number <= *last_ ? 1 : 0); }
        void pass(uint64_t number)
        {
            restarts_ = until(number);
            last_ = number;
        }
        /* From here on until(number) is `restarts`. */
        void set(uint64_t number, uint64_t restarts) { restarts_ += restarts - until(number); }

    private:
        uint64_t restarts_ = 0;
        std::optional<uint64_t> last_;
    };

    Restarts depths_, stacks_;
    unsigned apart_ = 0; /* in a row, where one stream alone seemed to have begun anew */
};

} // namespace dff
