-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- One pulse on a pin for each `fire`. The pulse is made so long that it has the length `width` behind the
-- opto-isolator, whose two edges are delayed by different times; the caller fires earlier by the delay of the
-- leading edge.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

library work;
  use work.timing_pkg.all;

entity trigger_output is
  generic (
    CLOCK_HZ : positive := 125_000_000;
    -- Rate of the time unit of width, opto_on and opto_off: microseconds
    TICK_HZ : positive := 1_000_000
  );
  port (
    clk        : in    std_ulogic;
    reset      : in    std_ulogic;
    fire       : in    std_ulogic;
    active_low : in    std_ulogic;
    width      : in    unsigned(15 downto 0);
    opto_on    : in    unsigned(7 downto 0);
    opto_off   : in    unsigned(7 downto 0);
    active     : out   std_ulogic;
    pin        : out   std_ulogic
  );
end entity trigger_output;

architecture rtl of trigger_output is

  constant TICK_CYCLES : positive := CLOCK_HZ / TICK_HZ;

  signal prescale  : natural range 0 to TICK_CYCLES - 1;
  signal remaining : unsigned(16 downto 0);
  signal pulse     : std_ulogic;
  signal level     : std_ulogic;

begin

  active <= pulse;
  pin    <= level;

  make_pulse : process (clk) is

    variable next_pulse : std_ulogic;

  begin

    if rising_edge(clk) then
      next_pulse := pulse;

      if (fire = '1' and pulse = '0') then
        next_pulse := '1';
        prescale   <= 0;
        remaining  <= resize(width, 17) + leading_delay(active_low, opto_on, opto_off)
                      - trailing_delay(active_low, opto_on, opto_off);
      elsif (pulse = '1') then
        if (prescale = TICK_CYCLES - 1) then
          prescale  <= 0;
          remaining <= remaining - 1;
          if (remaining = 1) then
            next_pulse := '0';
          end if;
        else
          prescale <= prescale + 1;
        end if;
      end if;

      if (reset = '1') then
        next_pulse := '0';
        prescale   <= 0;
        remaining  <= (others => '0');
      end if;

      pulse <= next_pulse;
      level <= next_pulse xor active_low;
    end if;

  end process make_pulse;

end architecture rtl;
