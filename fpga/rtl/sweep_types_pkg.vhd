-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- What the entities hand to each other as a whole. Times are in microseconds.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

package sweep_types_pkg is

  -- Words in use: the slots of a sweep. `lead` is the opto-isolator's delay of the edge that begins a trigger

  type sweep_words_t is record
    planes   : unsigned(6 downto 0);
    triangle : std_ulogic;
    period   : unsigned(15 downto 0);
    exposure : unsigned(15 downto 0);
    flyback  : unsigned(15 downto 0);
    lead     : unsigned(7 downto 0);
  end record sweep_words_t;

  -- Words in use: the trigger pulse

  type pulse_words_t is record
    active_low : std_ulogic;
    width      : unsigned(15 downto 0);
    opto_on    : unsigned(7 downto 0);
    opto_off   : unsigned(7 downto 0);
  end record pulse_words_t;

  -- Words in use: the lens driver's address and registers. `direct`: it takes a code in one write

  type driver_words_t is record
    address : std_ulogic_vector(6 downto 0);
    direct  : std_ulogic;
    start   : std_ulogic_vector(15 downto 0);
    stage   : std_ulogic_vector(15 downto 0);
    commit  : std_ulogic_vector(15 downto 0);
  end record driver_words_t;

  -- Committed words that the check needs. `trail` is the delay of the edge that ends a trigger, `new_level` that its
  -- polarity is not the one in use

  type checked_words_t is record
    planes    : unsigned(15 downto 0);
    period    : unsigned(15 downto 0);
    exposure  : unsigned(15 downto 0);
    width     : unsigned(15 downto 0);
    lead      : unsigned(7 downto 0);
    trail     : unsigned(7 downto 0);
    new_level : std_ulogic;
  end record checked_words_t;

  -- The sequencer asks for a word of a row: 0 code A, 1 delay, 2 code B, 3 settle. It comes one cycle after read

  type row_request_t is record
    plane  : unsigned(5 downto 0);
    column : unsigned(1 downto 0);
    read   : std_ulogic;
  end record row_request_t;

  -- The host's way to a word of a staged row

  type row_access_t is record
    plane  : unsigned(5 downto 0);
    column : unsigned(1 downto 0);
    write  : std_ulogic;
    data   : std_ulogic_vector(15 downto 0);
    read   : std_ulogic;
  end record row_access_t;

  -- Where the sweep is. One cycle each: trigger pulse, sync pulse (first plane of a sweep), last trigger of a sweep

  type progress_t is record
    busy      : std_ulogic;
    plane     : unsigned(5 downto 0);
    downward  : std_ulogic;
    fire      : std_ulogic;
    fire_sync : std_ulogic;
    boundary  : std_ulogic;
  end record progress_t;

end package sweep_types_pkg;
