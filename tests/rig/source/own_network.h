/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

namespace dff {

/* Moves this process into a network namespace that holds nothing but the loopback interface, which no packet
 * of a discovery leaves. To be called before any thread is started. False where that is not allowed. */
bool enter_own_network();

} // namespace dff
