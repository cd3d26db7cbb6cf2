// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the gst-plugins-dff authors
//
// The pins of a block RAM as the design uses it; replay.cpp has what it does: one port writes lanes of 9 bits, the other
// reads the word as it was before the clock. It begins with zeros.

module block_ram (
  input         write_clock,
  input         write,
  input  [1:0]  lanes,
  input  [9:0]  write_address,
  input  [17:0] write_data,
  input         read_clock,
  input         read,
  input  [9:0]  read_address,
  output [17:0] read_data
);

endmodule
