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

  -- Taken over for the slot in hand. The moments are worked out in the cycles that follow, one sum in each
  signal length        : unsigned(16 downto 0);
  signal held_exposure : unsigned(15 downto 0);
  signal held_lead     : unsigned(7 downto 0);
  signal expose_at     : unsigned(16 downto 0);
  signal fire_at       : unsigned(16 downto 0);

  -- The microsecond in hand, from 1 on, and the cycle in it
  signal slot_time : unsigned(16 downto 0);
  signal cycle     : natural range 0 to TICK_CYCLES - 1;

  -- One cycle each: the microsecond before a moment is over, the slot ends with this cycle
  signal fire_mark   : std_ulogic;
  signal expose_mark : std_ulogic;
  signal end_mark    : std_ulogic;

begin

  assert TICK_CYCLES >= 3
    report "slot_timer: the clock must be at least 3 times the rate of the time unit"
    severity failure;

  fire_due   <= fire_mark and running;
  expose_due <= expose_mark and running;
  slot_end   <= end_mark and running;

  count : process (clk) is
  begin

    if rising_edge(clk) then
      expose_at <= length - held_exposure;
      fire_at   <= expose_at - held_lead;

      fire_mark   <= '0';
      expose_mark <= '0';
      end_mark    <= '0';

      if (running = '0' or slot_end = '1') then
        slot_time     <= to_unsigned(1, 17);
        cycle         <= 0;
        length        <= resize(period, 17) + flyback;
        held_exposure <= exposure;
        held_lead     <= lead;
      elsif (cycle = TICK_CYCLES - 1) then
        slot_time <= slot_time + 1;
        cycle     <= 0;
        if (slot_time = fire_at) then
          fire_mark <= '1';
        end if;
        if (slot_time = expose_at) then
          expose_mark <= '1';
        end if;
      else
        cycle <= cycle + 1;
        if (cycle = TICK_CYCLES - 2 and slot_time = length) then
          end_mark <= '1';
        end if;
      end if;
    end if;

  end process count;

end architecture rtl;
