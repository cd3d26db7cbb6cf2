-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- Writes one byte to one register of the lens driver: start, address, register, value, stop; 29 bit times.
-- Waits for a stretched clock up to a limit, frees a data line that is held low with up to nine clocks, and ends
-- every transfer with `done` and, if it failed, the fault.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

library work;
  use work.timing_pkg.all;

entity i2c_master is
  generic (
    CLOCK_HZ        : positive := 125_000_000;
    BUS_HZ          : positive := 400_000;
    STRETCH_LIMIT_S : real     := 100.0e-6;
    -- Cycles from the pin to scl_in and sda_in: the synchroniser
    INPUT_CYCLES : positive := 9
  );
  port (
    clk             : in    std_ulogic;
    reset           : in    std_ulogic;
    start           : in    std_ulogic;
    address         : in    std_ulogic_vector(6 downto 0);
    register_number : in    std_ulogic_vector(7 downto 0);
    value           : in    std_ulogic_vector(7 downto 0);
    busy            : out   std_ulogic;
    done            : out   std_ulogic;
    -- Valid together with done
    nack             : out   std_ulogic;
    stretched        : out   std_ulogic;
    stuck            : out   std_ulogic;
    arbitration_lost : out   std_ulogic;
    -- The bus, synchronised; '1' on an output pulls the line low
    scl_in  : in    std_ulogic;
    sda_in  : in    std_ulogic;
    scl_low : out   std_ulogic;
    sda_low : out   std_ulogic
  );
end entity i2c_master;

architecture rtl of i2c_master is

  constant BIT_CYCLES     : positive := to_period(CLOCK_HZ, BUS_HZ);
  constant STRETCH_CYCLES : positive := to_cycles(CLOCK_HZ, STRETCH_LIMIT_S);

  -- A bit is SCL low, then released and given time to rise and to pass the synchroniser, then seen high.
  -- A quarter for the high time and a sixth for the rise leave SCL low for the 1.3 us that a fast-mode bus needs.
  constant RISE_CYCLES : positive := maximum_of(BIT_CYCLES / 6, INPUT_CYCLES + 1);
  constant HIGH_CYCLES : positive := maximum_of(1, BIT_CYCLES / 4);
  constant LOW_CYCLES  : positive := maximum_of(1, BIT_CYCLES - RISE_CYCLES - HIGH_CYCLES);

  constant RECOVERY_CLOCKS : positive := 9;

  type state_t is (
    idle_state, free_state, start_state, send_state, stop_state, recover_state, recover_stop_state
  );

  -- Part of a bit

  type phase_t is (low_phase, rise_phase, high_phase);

  signal state   : state_t;
  signal phase   : phase_t;
  signal count   : natural range 0 to BIT_CYCLES;
  signal stretch : natural range 0 to STRETCH_CYCLES;
  -- Bits sent of the 27 (three bytes with their acknowledges), or clocks of the recovery
  signal bit_index : natural range 0 to 27;
  -- The acknowledge bits stand in it as ones: the line is released
  signal shifter : std_ulogic_vector(26 downto 0);

  function is_acknowledge (
    index : natural
  ) return boolean is
  begin

    return index = 8 or index = 17 or index = 26;

  end function is_acknowledge;

begin

  assert CLOCK_HZ / BUS_HZ >= 10
    report "i2c_master: the clock must be at least 10 times the bus rate"
    severity failure;

  assert LOW_CYCLES > INPUT_CYCLES
    report "i2c_master: the lines of a stop do not pass the synchroniser within the bus-free time"
    severity failure;

  assert BUS_HZ > 400_000 or LOW_CYCLES >= to_cycles(CLOCK_HZ, 1.3e-6)
    report "i2c_master: SCL is low for less than the 1.3 us of a fast-mode bus"
    severity failure;

  assert BUS_HZ > 400_000 or HIGH_CYCLES + INPUT_CYCLES >= to_cycles(CLOCK_HZ, 0.6e-6)
    report "i2c_master: SCL is high for less than the 0.6 us of a fast-mode bus"
    severity failure;

  transfer : process (clk) is

    -- The phase ends in this cycle
    variable phase_end : boolean;

    procedure finish is
    begin

      state   <= idle_state;
      busy    <= '0';
      done    <= '1';
      scl_low <= '0';
      sda_low <= '0';

    end procedure finish;

    -- Next phase of a bit whose SCL is pulled low, then released; waits in rise_phase while SCL is stretched

    procedure run_clock is
    begin

      phase_end := false;

      case phase is

        when low_phase =>

          if (count = LOW_CYCLES - 1) then
            count   <= 0;
            stretch <= 0;
            scl_low <= '0';
            phase   <= rise_phase;
          else
            count <= count + 1;
          end if;

        when rise_phase =>

          if (count /= RISE_CYCLES - 1) then
            count <= count + 1;
          elsif (scl_in = '1') then
            count <= 0;
            phase <= high_phase;
          elsif (stretch = STRETCH_CYCLES) then
            stretched <= '1';
            finish;
          else
            stretch <= stretch + 1;
          end if;

        when high_phase =>

          if (count = HIGH_CYCLES - 1) then
            count     <= 0;
            phase     <= low_phase;
            phase_end := true;
          else
            count <= count + 1;
          end if;

      end case;

    end procedure run_clock;

  begin

    if rising_edge(clk) then
      done <= '0';

      case state is

        when idle_state =>

          scl_low   <= '0';
          sda_low   <= '0';
          count     <= 0;
          stretch   <= 0;
          bit_index <= 0;
          phase     <= low_phase;
          if (start = '1') then
            state            <= free_state;
            busy             <= '1';
            nack             <= '0';
            stretched        <= '0';
            stuck            <= '0';
            arbitration_lost <= '0';
            shifter          <= address & '0' & '1' & register_number & '1' & value & '1';
          end if;

        -- The bus-free time; by its end the lines of the last stop have passed the synchroniser. Then both are
        -- high, or wait for the clock, or free the data line
        when free_state =>

          if (count /= LOW_CYCLES - 1) then
            count <= count + 1;
          elsif (scl_in = '0') then
            if (stretch = STRETCH_CYCLES) then
              stretched <= '1';
              finish;
            else
              stretch <= stretch + 1;
            end if;
          elsif (sda_in = '0') then
            state   <= recover_state;
            scl_low <= '1';
            count   <= 0;
          else
            state   <= start_state;
            sda_low <= '1';
            count   <= 0;
          end if;

        when start_state =>

          if (count = RISE_CYCLES + HIGH_CYCLES - 1) then
            state   <= send_state;
            scl_low <= '1';
            count   <= 0;
          else
            count <= count + 1;
          end if;

        when send_state =>

          if (phase = low_phase and count = LOW_CYCLES / 2) then
            sda_low <= not shifter(26);
          end if;
          run_clock;
          if (phase_end) then
            scl_low   <= '1';
            shifter   <= shifter(25 downto 0) & '1';
            bit_index <= bit_index + 1;
            if (is_acknowledge(bit_index)) then
              if (sda_in = '1') then
                nack      <= '1';
                state     <= stop_state;
                bit_index <= 0;
              end if;
            elsif (shifter(26) = '1' and sda_in = '0') then
              arbitration_lost <= '1';
              finish;
            end if;
            if (bit_index = 26) then
              state     <= stop_state;
              bit_index <= 0;
            end if;
          end if;

        when stop_state =>

          if (phase = low_phase and count = LOW_CYCLES / 2) then
            sda_low <= '1';
          end if;
          run_clock;
          if (phase_end) then
            finish;
          end if;

        -- A slave that was cut off in a read lets go of the data line after at most nine clocks
        when recover_state =>

          run_clock;
          if (phase_end) then
            scl_low   <= '1';
            bit_index <= bit_index + 1;
            if (sda_in = '1') then
              state     <= recover_stop_state;
              bit_index <= 0;
            elsif (bit_index = RECOVERY_CLOCKS - 1) then
              stuck <= '1';
              finish;
            end if;
          end if;

        when recover_stop_state =>

          if (phase = low_phase and count = LOW_CYCLES / 2) then
            sda_low <= '1';
          end if;
          run_clock;
          if (phase_end) then
            sda_low <= '0';
            state   <= free_state;
          end if;

      end case;

      if (reset = '1') then
        state            <= idle_state;
        busy             <= '0';
        done             <= '0';
        nack             <= '0';
        stretched        <= '0';
        stuck            <= '0';
        arbitration_lost <= '0';
        scl_low          <= '0';
        sda_low          <= '0';
      end if;
    end if;

  end process transfer;

end architecture rtl;
