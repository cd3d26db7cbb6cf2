/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "bench_process.h"
#include "watched_stream.h"

#include <string>

namespace dff {

/* A proof is short unless DFF_RIG_SECONDS and DFF_RIG_CYCLES ask for its full length; DFF_RIG_RATE is in
 * sweeps a second. */
double seconds_of_proof(double otherwise);
int cycles_of_proof(int otherwise);
int rate_of_proof(int otherwise);

/* What lenssweepsrc says it got and lost is what the bench camera says it sent and lost: no frame is
 * unaccounted for. */
void expect_accounts_agree(const WatchedStream &stream, const BenchProcess::Counts &bench);

} // namespace dff
