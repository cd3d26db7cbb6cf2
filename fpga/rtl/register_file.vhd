-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The words that the host sees. Keeps the staged words in three copies: as written, as committed and checked, and in
-- use; collects the errors; counts sweeps and frames.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

library work;
  use work.sweep_registers_pkg.all;
  use work.sweep_types_pkg.all;
  use work.timing_pkg.all;

entity register_file is
  generic (
    CLOCK_HZ    : positive := 125_000_000;
    TICK_HZ     : positive := 1_000_000;
    LENS_BUS_HZ : positive := 400_000
  );
  port (
    clk   : in    std_ulogic;
    reset : in    std_ulogic;
    -- Host
    word_number : in    unsigned(6 downto 0);
    writable    : out   std_ulogic;
    read        : in    std_ulogic;
    read_data   : out   std_ulogic_vector(15 downto 0);
    write       : in    std_ulogic;
    write_data  : in    std_ulogic_vector(15 downto 0);
    -- Table of planes: the row shown to the host, and the commit
    table : out   row_access_t;
    -- One cycle after its read
    table_q : in    std_ulogic_vector(15 downto 0);
    commit  : out   std_ulogic;
    pending : in    std_ulogic;
    apply   : in    std_ulogic;
    -- Committed words, for the check
    checked : out   checked_words_t;
    -- Words in use
    sweep  : out   sweep_words_t;
    pulse  : out   pulse_words_t;
    driver : out   driver_words_t;
    -- Sequencer
    run      : in    std_ulogic;
    go       : out   std_ulogic;
    progress : in    progress_t;
    -- Faults: one bit for each bit of the word `error`
    sweep_faults      : in    std_ulogic_vector(4 downto 0);
    table_faults      : in    std_ulogic_vector(2 downto 0);
    table_fault_plane : in    unsigned(5 downto 0);
    error             : out   std_ulogic
  );
end entity register_file;

architecture rtl of register_file is

  constant LENS_GAP    : positive := to_write_time(CLOCK_HZ, TICK_HZ, LENS_BUS_HZ, 4);
  constant LENS_STAGED : positive := to_write_time(CLOCK_HZ, TICK_HZ, LENS_BUS_HZ, 2);

  subtype staged_t is natural range WORD_PLANES to WORD_LENS_COMMIT;

  signal staged           : words_t(staged_t);
  signal committed        : words_t(staged_t);
  signal active           : words_t(staged_t);
  signal control          : word_t;
  signal selected         : unsigned(5 downto 0);
  signal errors           : std_ulogic_vector(7 downto 0);
  signal raised           : std_ulogic_vector(7 downto 0);
  signal error_at         : unsigned(5 downto 0);
  signal table_valid      : std_ulogic;
  signal sweeps           : unsigned(31 downto 0);
  signal frames           : unsigned(31 downto 0);
  signal latched_high     : std_ulogic_vector(15 downto 0);
  signal status           : word_t;
  signal checked_level    : std_ulogic;
  signal checked_opto_on  : unsigned(7 downto 0);
  signal checked_opto_off : unsigned(7 downto 0);
  signal number           : natural range 0 to 127;
  signal selection        : word_t;
  signal read_shift       : std_ulogic_vector(1 to 2);

  function is_row (
    word : natural
  ) return boolean is
  begin

    return word >= WORD_PLANE_CODE_A and word <= WORD_PLANE_SETTLE_US;

  end function is_row;

begin

  error <= '0' when errors = x"00" else
           '1';

  sweep.planes   <= unsigned(active(WORD_PLANES)(6 downto 0));
  sweep.triangle <= active(WORD_SHAPE)(SHAPE_TRIANGLE);
  sweep.period   <= unsigned(active(WORD_PERIOD_US));
  sweep.exposure <= unsigned(active(WORD_EXPOSURE_US));
  sweep.flyback  <= unsigned(active(WORD_FLYBACK_US));
  sweep.lead     <= leading_delay(pulse.active_low, pulse.opto_on, pulse.opto_off);

  pulse.active_low <= active(WORD_SHAPE)(SHAPE_TRIGGER_ACTIVE_LOW);
  pulse.width      <= unsigned(active(WORD_TRIGGER_WIDTH_US));
  pulse.opto_on    <= unsigned(active(WORD_OPTO_ON_US)(opto_on_us_value_t));
  pulse.opto_off   <= unsigned(active(WORD_OPTO_OFF_US)(opto_off_us_value_t));

  driver.address <= active(WORD_LENS_ADDRESS)(lens_address_value_t);
  driver.direct  <= active(WORD_LENS_ADDRESS)(LENS_ADDRESS_DIRECT);
  driver.start   <= active(WORD_LENS_START);
  driver.stage   <= active(WORD_LENS_STAGE);
  driver.commit  <= active(WORD_LENS_COMMIT);

  checked_level    <= committed(WORD_SHAPE)(SHAPE_TRIGGER_ACTIVE_LOW);
  checked_opto_on  <= unsigned(committed(WORD_OPTO_ON_US)(opto_on_us_value_t));
  checked_opto_off <= unsigned(committed(WORD_OPTO_OFF_US)(opto_off_us_value_t));

  checked.planes    <= unsigned(committed(WORD_PLANES));
  checked.period    <= unsigned(committed(WORD_PERIOD_US));
  checked.exposure  <= unsigned(committed(WORD_EXPOSURE_US));
  checked.width     <= unsigned(committed(WORD_TRIGGER_WIDTH_US));
  checked.lead      <= leading_delay(checked_level, checked_opto_on, checked_opto_off);
  checked.trail     <= trailing_delay(checked_level, checked_opto_on, checked_opto_off);
  checked.new_level <= checked_level xor pulse.active_low;

  table.plane  <= selected;
  table.column <= to_unsigned(number - WORD_PLANE_CODE_A, 2) when is_row(number) else
                  "00";

  status(STATUS_BUSY)           <= progress.busy;
  status(STATUS_TABLE_VALID)    <= table_valid;
  status(STATUS_COMMIT_PENDING) <= pending;
  status(STATUS_DOWNWARD)       <= progress.downward;
  status(STATUS_RUN)            <= run;
  status(STATUS_FAILED)         <= error;
  status(status_plane_t)        <= std_ulogic_vector(progress.plane);
  status(15 downto 12)          <= "0000";

  number <= to_integer(word_number);

  host_writes : process (clk) is
  begin

    if rising_edge(clk) then
      commit      <= '0';
      table.write <= '0';

      writable <= '0';
      if (number < WORD_COUNT) then
        if (WRITE_MASKS(number) /= x"0000") then
          writable <= '1';
        end if;
      end if;

      if (write = '1') then
        if (number >= staged_t'low and number <= staged_t'high) then
          staged(number) <= write_data and WRITE_MASKS(number);
        elsif (number = WORD_CONTROL) then
          control <= write_data and WRITE_MASKS(WORD_CONTROL);
        elsif (number = WORD_COMMIT) then
          commit <= write_data(COMMIT_COMMIT);
        elsif (number = WORD_PLANE_SELECT) then
          selected <= unsigned(write_data(plane_select_plane_t));
        elsif (is_row(number)) then
          table.write <= '1';
          table.data  <= write_data;
        end if;
      end if;

      if (commit = '1') then
        committed <= staged;
      end if;
      if (apply = '1') then
        active      <= committed;
        table_valid <= '1';
      end if;

      if (reset = '1') then

        for index in staged_t loop

          staged(index)    <= DEFAULTS(index);
          committed(index) <= DEFAULTS(index);
          active(index)    <= DEFAULTS(index);

        end loop;

        control     <= DEFAULTS(WORD_CONTROL);
        commit      <= '0';
        table.write <= '0';
        selected    <= (others => '0');
        table_valid <= '0';
      end if;
    end if;

  end process host_writes;

  gate : process (clk) is
  begin

    if rising_edge(clk) then
      go <= control(CONTROL_ENABLE) and (run or not control(CONTROL_GATED)) and table_valid and not error;
      if (reset = '1') then
        go <= '0';
      end if;
    end if;

  end process gate;

  raised <= table_faults & sweep_faults;

  collect_errors : process (clk) is

    variable kept : std_ulogic_vector(7 downto 0);

  begin

    if rising_edge(clk) then
      kept := errors;
      if (write = '1' and number = WORD_ERROR) then
        kept   := errors and not write_data(7 downto 0);
        errors <= kept;
      end if;

      if (raised /= x"00") then
        errors <= kept or raised;
        if (kept = x"00") then
          if (sweep_faults /= "00000") then
            error_at <= progress.plane;
          else
            error_at <= table_fault_plane;
          end if;
        end if;
      end if;

      if (reset = '1') then
        errors   <= (others => '0');
        error_at <= (others => '0');
      end if;
    end if;

  end process collect_errors;

  count : process (clk) is
  begin

    if rising_edge(clk) then
      if (progress.fire_sync = '1') then
        sweeps <= sweeps + 1;
      end if;
      if (progress.fire = '1') then
        frames <= frames + 1;
      end if;
      if (reset = '1') then
        sweeps <= (others => '0');
        frames <= (others => '0');
      end if;
    end if;

  end process count;

  -- The word that the host reads
  select_word : process (all) is
  begin

    case number is

      when WORD_IDENTITY | WORD_VERSION =>

        selection <= DEFAULTS(number);

      when WORD_CONTROL =>

        selection <= control;

      when WORD_STATUS =>

        selection <= status;

      when WORD_ERROR =>

        selection <= x"00" & errors;

      when WORD_ERROR_PLANE =>

        selection <= std_ulogic_vector(resize(error_at, 16));

      when WORD_SWEEP_COUNT_LOW =>

        selection <= std_ulogic_vector(sweeps(15 downto 0));

      when WORD_FRAME_COUNT_LOW =>

        selection <= std_ulogic_vector(frames(15 downto 0));

      when WORD_SWEEP_COUNT_HIGH | WORD_FRAME_COUNT_HIGH =>

        selection <= latched_high;

      when WORD_LENS_GAP_US =>

        selection <= std_ulogic_vector(to_unsigned(LENS_GAP, 16));

      when WORD_LENS_STAGE_US =>

        selection <= std_ulogic_vector(to_unsigned(LENS_STAGED, 16));

      when WORD_PLANES to WORD_LENS_COMMIT =>

        selection <= staged(number);

      when WORD_PLANE_SELECT =>

        selection <= std_ulogic_vector(resize(selected, 16));

      when WORD_PLANE_CODE_A | WORD_PLANE_DELAY_US | WORD_PLANE_CODE_B | WORD_PLANE_SETTLE_US =>

        selection <= table_q;

      when WORD_COMMIT =>

        selection <= x"0000";

      when others =>

        selection <= x"FFFF";

    end case;

  end process select_word;

  host_reads : process (clk) is
  begin

    if rising_edge(clk) then
      read_shift <= read & read_shift(1);
      table.read <= read;
      if (read_shift(2) = '1') then
        read_data <= selection;
      end if;

      if (read = '1' and number = WORD_SWEEP_COUNT_LOW) then
        latched_high <= std_ulogic_vector(sweeps(31 downto 16));
      elsif (read = '1' and number = WORD_FRAME_COUNT_LOW) then
        latched_high <= std_ulogic_vector(frames(31 downto 16));
      end if;

      if (reset = '1') then
        read_shift   <= "00";
        table.read   <= '0';
        latched_high <= (others => '0');
      end if;
    end if;

  end process host_reads;

end architecture rtl;
