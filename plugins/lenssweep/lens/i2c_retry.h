/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "i2c_bus.h"

namespace dff {

constexpr int i2c_tries = 3;

/* What `transfer` returns. If it keeps failing with I2cError, `give_up` is called, and the error thrown on.
 */
template <typename Transfer, typename GiveUp> auto with_retries(Transfer transfer, GiveUp give_up)
{
    for (int attempt = 1;; ++attempt) {
        try {
            return transfer();
        } catch (const I2cError &) {
            if (attempt == i2c_tries) {
                give_up();
                throw;
            }
        }
    }
}

/* Tries the transfer, and lets it be if it keeps failing: for stopping what does not hear any more. */
template <typename Transfer> void try_quietly(Transfer transfer) noexcept
{
    try {
        with_retries(transfer, [] {});
    } catch (const I2cError &) {
        /* Nothing more can be done. */
    }
}

} // namespace dff
