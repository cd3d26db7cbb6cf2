-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The top on a bench: a clock, pull-ups, and open-drain inputs for the models of the host and of the lens driver. The
-- models pull weakly, so that a pin tells whether the design itself holds it low: '0', and 'L' if only a model does.

library ieee;
  use ieee.std_logic_1164.all;

library std;
  use std.textio.all;

entity lens_sweep_bench is
  generic (
    CLOCK_HZ : positive := 8_000_000;
    -- How many times faster than real the microsecond, the lens bus and the limits run
    SCALE : positive := 1;
    -- File for the pins as they are at each clock edge, for the replay on a netlist; none if empty
    TRACE : string := ""
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

  -- Whole picoseconds, as the benches count
  constant HALF_PERIOD : time := 1 sec / CLOCK_HZ / 2 / 1 ps * 1 ps;

  signal clk          : std_ulogic := '0';
  signal host_scl_pin : std_logic;
  signal host_sda_pin : std_logic;
  signal lens_scl_pin : std_logic;
  signal lens_sda_pin : std_logic;

begin

  clk <= not clk after HALF_PERIOD;

  host_scl_pin <= 'L' when host_scl_low = '1' else
                  'H';
  host_sda_pin <= 'L' when host_sda_low = '1' else
                  'H';
  lens_scl_pin <= 'L' when lens_scl_low = '1' else
                  'H';
  lens_sda_pin <= 'L' when lens_sda_low = '1' else
                  'H';

  host_sda <= to_x01(host_sda_pin);
  lens_scl <= to_x01(lens_scl_pin);
  lens_sda <= to_x01(lens_sda_pin);

  -- Number of the edge and the pins at it, for each edge at which a pin has changed

  record_pins : if TRACE'length /= 0 generate

    write_trace : process (clk) is

      file     trace_file : text open write_mode is TRACE;
      variable row        : line;
      variable edge       : natural;
      variable pins       : std_ulogic_vector(1 to 10);
      variable written    : std_ulogic_vector(1 to 10);

    begin

      if rising_edge(clk) then
        pins := reset_button & run & host_scl_pin & host_sda_pin & lens_scl_pin & lens_sda_pin &
                sync & trigger & busy & error;
        if (edge = 0 or pins /= written) then
          write(row, edge);
          write(row, ' ');
          write(row, to_string(pins));
          writeline(trace_file, row);
          written := pins;
        end if;
        edge := edge + 1;
      end if;

    end process write_trace;

  end generate record_pins;

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
