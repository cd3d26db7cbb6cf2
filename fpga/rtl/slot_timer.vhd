-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The time in a slot, and the moments that hang on it. One slot follows the other by the count alone: nothing that
-- happens on a bus can move a trigger.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

entity slot_timer is
  generic (
    CLOCK_HZ : positive := 125_000_000;
    -- Rate of the time unit of all times here: microseconds
    TICK_HZ : positive := 1_000_000
  );
  port (
    clk : in    std_ulogic;
    -- '0' holds the timer at the start of a slot
    running : in    std_ulogic;
    -- Taken over when a slot begins
    period   : in    unsigned(15 downto 0);
    flyback  : in    unsigned(15 downto 0);
    exposure : in    unsigned(15 downto 0);
    lead     : in    unsigned(7 downto 0);
    -- One cycle each
    fire_due   : out   std_ulogic;
    expose_due : out   std_ulogic;
    slot_end   : out   std_ulogic
  );
end entity slot_timer;

architecture rtl of slot_timer is

  constant TICK_CYCLES : positive := CLOCK_HZ / TICK_HZ;

  subtype time_t is natural range 0 to 2 ** 17 - 1;

  signal length    : unsigned(16 downto 0);
  signal fire_at   : time_t;
  signal expose_at : time_t;
  signal last_tick : time_t;
  signal slot_time : time_t;
  signal cycle     : natural range 0 to TICK_CYCLES - 1;

begin

  length <= resize(period, 17) + flyback;

  moments : process (all) is
  begin

    fire_due   <= '0';
    expose_due <= '0';
    slot_end   <= '0';

    if (running = '1' and cycle = 0) then
      if (slot_time = fire_at) then
        fire_due <= '1';
      end if;
      if (slot_time = expose_at) then
        expose_due <= '1';
      end if;
    end if;

    if (running = '1' and cycle = TICK_CYCLES - 1 and slot_time = last_tick) then
      slot_end <= '1';
    end if;

  end process moments;

  count : process (clk) is
  begin

    if rising_edge(clk) then
      if (running = '0' or slot_end = '1') then
        slot_time <= 0;
        cycle     <= 0;
        fire_at   <= to_integer(length - exposure - lead);
        expose_at <= to_integer(length - exposure);
        last_tick <= to_integer(length - 1);
      elsif (cycle = TICK_CYCLES - 1) then
        slot_time <= slot_time + 1;
        cycle     <= 0;
      else
        cycle <= cycle + 1;
      end if;
    end if;

  end process count;

end architecture rtl;
