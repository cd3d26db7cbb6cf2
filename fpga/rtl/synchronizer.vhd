-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- Brings one asynchronous input into the clock domain and drops pulses shorter than GLITCH_S.

library ieee;
  use ieee.std_logic_1164.all;

library work;
  use work.timing_pkg.all;

entity synchronizer is
  generic (
    CLOCK_HZ    : positive   := 125_000_000;
    GLITCH_S    : real       := 50.0e-9;
    RESET_LEVEL : std_ulogic := '1'
  );
  port (
    clk      : in    std_ulogic;
    reset    : in    std_ulogic;
    async_in : in    std_ulogic;
    sync_out : out   std_ulogic
  );
end entity synchronizer;

architecture rtl of synchronizer is

  constant GLITCH_CYCLES : positive := to_cycles(CLOCK_HZ, GLITCH_S);

  -- Two flip-flops: the first may be metastable for a clock
  signal metastable : std_ulogic;
  signal stable     : std_ulogic;
  signal level      : std_ulogic;
  signal count      : natural range 0 to GLITCH_CYCLES - 1;

  -- Placed side by side, and neither replicated nor made a shift register
  attribute async_reg                       : string;
  attribute keep                            : string;
  attribute async_reg of metastable, stable : signal is "TRUE";
  attribute keep of metastable, stable      : signal is "TRUE";

begin

  sync_out <= level;

  filter : process (clk) is
  begin

    if rising_edge(clk) then
      metastable <= async_in;
      stable     <= metastable;

      if (stable = level) then
        count <= 0;
      elsif (count = GLITCH_CYCLES - 1) then
        count <= 0;
        level <= stable;
      else
        count <= count + 1;
      end if;

      if (reset = '1') then
        metastable <= RESET_LEVEL;
        stable     <= RESET_LEVEL;
        level      <= RESET_LEVEL;
        count      <= 0;
      end if;
    end if;

  end process filter;

end architecture rtl;
