-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- Turns hertz and seconds into clock cycles, at elaboration only: nothing here becomes a divider or a multiplier.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

package timing_pkg is

  -- Bits of a byte write on the lens bus: start, address, register and value with their acknowledges, stop
  constant BITS_PER_WRITE : positive := 29;

  -- Clock cycles that `seconds` take, rounded up, at least 1

  function to_cycles (
    clock_hz : positive;
    seconds : real
  ) return positive;

  -- Clock cycles of one period of `rate_hz`, rounded up: the rate is never exceeded

  function to_period (
    clock_hz : positive;
    rate_hz : positive
  ) return positive;

  -- Time units (microseconds) that `writes` byte writes on the lens bus take, rounded up

  function to_write_time (
    clock_hz : positive;
    tick_hz  : positive;
    bus_hz   : positive;
    writes   : positive
  ) return positive;

  function maximum_of (
    left,
    right : integer
  ) return integer;

  -- Delay of the edge that begins a trigger pulse, behind the opto-isolator

  function leading_delay (
    active_low : std_ulogic;
    opto_on,
    opto_off : unsigned
  ) return unsigned;

  -- Delay of the edge that ends it

  function trailing_delay (
    active_low : std_ulogic;
    opto_on,
    opto_off : unsigned
  ) return unsigned;

end package timing_pkg;

package body timing_pkg is

  -- Cycles between two writes in which the sequencer and the master hand over, with a reserve
  constant HANDOVER_CYCLES : positive := 6;

  function to_cycles (
    clock_hz : positive;
    seconds : real
  ) return positive is

    constant EXACT   : real    := real(clock_hz) * seconds;
    constant ROUNDED : integer := integer(EXACT);

  begin

    if (real(ROUNDED) < EXACT - 1.0e-6) then
      return ROUNDED + 1;
    end if;

    return maximum_of(ROUNDED, 1);

  end function to_cycles;

  function to_period (
    clock_hz : positive;
    rate_hz : positive
  ) return positive is
  begin

    return (clock_hz + rate_hz - 1) / rate_hz;

  end function to_period;

  function to_write_time (
    clock_hz : positive;
    tick_hz  : positive;
    bus_hz   : positive;
    writes   : positive
  ) return positive is

    constant CYCLES : positive := writes * (BITS_PER_WRITE * to_period(clock_hz, bus_hz) + HANDOVER_CYCLES);

  begin

    return to_period(CYCLES, clock_hz / tick_hz);

  end function to_write_time;

  function maximum_of (
    left,
    right : integer
  ) return integer is
  begin

    if (left > right) then
      return left;
    end if;

    return right;

  end function maximum_of;

  function leading_delay (
    active_low : std_ulogic;
    opto_on,
    opto_off : unsigned
  ) return unsigned is
  begin

    if (active_low = '1') then
      return opto_off;
    end if;

    return opto_on;

  end function leading_delay;

  function trailing_delay (
    active_low : std_ulogic;
    opto_on,
    opto_off : unsigned
  ) return unsigned is
  begin

    return leading_delay(not active_low, opto_on, opto_off);

  end function trailing_delay;

end package body timing_pkg;
