-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The top on a bench: a clock, pull-ups, and open-drain inputs for the models of the host and of the lens driver.

library ieee;
  use ieee.std_logic_1164.all;

entity lens_sweep_bench is
  generic (
    CLOCK_HZ : positive := 8_000_000;
    -- How many times faster than real the microsecond, the lens bus and the limits run
    SCALE : positive := 1
  );
  port (
    reset_button : in    std_ulogic;
    run          : in    std_ulogic;
    host_scl_low : in    std_ulogic;
    host_sda_low : in    std_ulogic;
    lens_scl_low : in    std_ulogic;
    lens_sda_low : in    std_ulogic;
    host_sda     : out   std_ulogic;
    lens_scl     : out   std_ulogic;
    lens_sda     : out   std_ulogic;
    sync         : out   std_ulogic;
    trigger      : out   std_ulogic;
    busy         : out   std_ulogic;
    error        : out   std_ulogic
  );
end entity lens_sweep_bench;

architecture bench of lens_sweep_bench is

  constant HALF_PERIOD : time := 1 sec / CLOCK_HZ / 2;

  signal clk          : std_ulogic := '0';
  signal host_scl_pin : std_logic;
  signal host_sda_pin : std_logic;
  signal lens_scl_pin : std_logic;
  signal lens_sda_pin : std_logic;

begin

  clk <= not clk after HALF_PERIOD;

  host_scl_pin <= '0' when host_scl_low = '1' else
                  'H';
  host_sda_pin <= '0' when host_sda_low = '1' else
                  'H';
  lens_scl_pin <= '0' when lens_scl_low = '1' else
                  'H';
  lens_sda_pin <= '0' when lens_sda_low = '1' else
                  'H';

  host_sda <= to_x01(host_sda_pin);
  lens_scl <= to_x01(lens_scl_pin);
  lens_sda <= to_x01(lens_sda_pin);

  dut : entity work.lens_sweep_top
    generic map (
      CLOCK_HZ        => CLOCK_HZ,
      TICK_HZ         => 1_000_000 * SCALE,
      LENS_BUS_HZ     => 400_000 * SCALE,
      STRETCH_LIMIT_S => 100.0e-6 / real(SCALE),
      GLITCH_S        => 50.0e-9 / real(SCALE),
      HOST_HOLD_S     => 300.0e-9 / real(SCALE),
      HOST_TIMEOUT_S  => 25.0e-3 / real(SCALE)
    )
    port map (
      clk          => clk,
      reset_button => reset_button,
      run          => run,
      sync         => sync,
      trigger      => trigger,
      busy         => busy,
      error        => error,
      host_scl     => host_scl_pin,
      host_sda     => host_sda_pin,
      lens_scl     => lens_scl_pin,
      lens_sda     => lens_sda_pin
    );

end architecture bench;
