-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The table of planes: a staged copy that the host writes, and two banks of which the sequencer reads one. A commit
-- copies the staged table to the other bank and checks it on the way; the banks are exchanged between two sweeps.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

library work;
  use work.sweep_types_pkg.all;
  use work.timing_pkg.all;

entity plane_table is
  generic (
    CLOCK_HZ    : positive := 125_000_000;
    TICK_HZ     : positive := 1_000_000;
    LENS_BUS_HZ : positive := 400_000
  );
  port (
    clk   : in    std_ulogic;
    reset : in    std_ulogic;
    -- The staged table; host_q is valid one cycle after a read
    host   : in    row_access_t;
    host_q : out   std_ulogic_vector(15 downto 0);
    -- The committed words are valid two cycles after commit
    commit  : in    std_ulogic;
    checked : in    checked_words_t;
    pending : out   std_ulogic;
    -- One cycle each
    apply      : out   std_ulogic;
    bad_planes : out   std_ulogic;
    bad_timing : out   std_ulogic;
    bad_code   : out   std_ulogic;
    bad_plane  : out   unsigned(5 downto 0);
    -- Sequencer; table_data is valid one cycle after a read
    idle       : in    std_ulogic;
    boundary   : in    std_ulogic;
    table      : in    row_request_t;
    table_data : out   std_ulogic_vector(15 downto 0)
  );
end entity plane_table;

architecture rtl of plane_table is

  constant LENS_GAP    : positive := to_write_time(CLOCK_HZ, TICK_HZ, LENS_BUS_HZ, 4);
  constant LENS_STAGED : positive := to_write_time(CLOCK_HZ, TICK_HZ, LENS_BUS_HZ, 2);
  constant MAX_CODE    : positive := 1023;

  type memory_t is array (natural range <>) of std_ulogic_vector(15 downto 0);

  signal staged : memory_t(0 to 255) := (others => (others => '0'));
  signal banks  : memory_t(0 to 511) := (others => (others => '0'));

  type state_t is (idle_state, settings_state, copy_state, verdict_state);

  signal state : state_t;
  signal step  : natural range 0 to 5;
  -- Word in hand of the copy: plane and column
  signal address        : unsigned(7 downto 0);
  signal host_word      : std_ulogic_vector(15 downto 0);
  signal staged_address : natural range 0 to 255;
  signal staged_enable  : std_ulogic;
  signal copying        : std_ulogic;

  -- The word that leaves the memory in a copy, and one cycle later: the memory itself is slow
  signal leaving         : std_ulogic;
  signal leaving_address : unsigned(7 downto 0);
  signal copied          : std_ulogic;
  signal copied_address  : unsigned(7 downto 0);
  signal copied_word     : std_ulogic_vector(15 downto 0);

  signal bank   : std_ulogic;
  signal gap    : unsigned(16 downto 0);
  signal delay  : unsigned(17 downto 0);
  signal settle : unsigned(17 downto 0);
  signal check  : std_ulogic_vector(1 to 2);
  -- The sum of a plane's times is ready one cycle after its last word, the verdict one later
  signal settled_plane : unsigned(5 downto 0);
  signal checked_plane : unsigned(5 downto 0);
  signal needed        : unsigned(17 downto 0);
  signal refused       : std_ulogic;

begin

  copying        <= '1' when state = copy_state else
                    '0';
  staged_address <= to_integer(address) when copying = '1' else
                    to_integer(host.plane & host.column);
  staged_enable  <= copying or host.read;

  host_q <= host_word;

  staged_memory : process (clk) is
  begin

    if rising_edge(clk) then
      if (host.write = '1') then
        staged(to_integer(host.plane & host.column)) <= host.data;
      end if;
      if (staged_enable = '1') then
        host_word <= staged(staged_address);
      end if;
    end if;

  end process staged_memory;

  bank_memory : process (clk) is
  begin

    if rising_edge(clk) then
      if (copied = '1') then
        banks(to_integer((not bank) & copied_address)) <= copied_word;
      end if;
      if (table.read = '1') then
        table_data <= banks(to_integer(bank & table.plane & table.column));
      end if;
    end if;

  end process bank_memory;

  check_and_copy : process (clk) is

    procedure refuse (
      signal reason : out std_ulogic;
      at_plane      : unsigned
    ) is
    begin

      if (refused = '0') then
        reason    <= '1';
        bad_plane <= at_plane;
      end if;

      refused <= '1';

    end procedure refuse;

  begin

    if rising_edge(clk) then
      apply      <= '0';
      bad_planes <= '0';
      bad_timing <= '0';
      bad_code   <= '0';

      leaving        <= copying;
      copied         <= leaving;
      copied_address <= leaving_address;
      copied_word    <= host_word;

      gap <= resize(checked.period, 17) - resize(checked.exposure, 17);

      case state is

        when idle_state =>

          step <= 0;

        when settings_state =>

          step <= step + 1;
          if (step = 4) then
            step  <= 0;
            state <= copy_state;
            if (checked.planes < 2 or checked.planes > 64) then
              refuse(bad_planes, to_unsigned(0, 6));
              state <= idle_state;
            elsif (checked.period <= checked.exposure or checked.exposure < LENS_STAGED or checked.width = 0
                   or checked.width > checked.exposure
                   or resize(checked.width, 17) + checked.lead <= checked.trail) then
              refuse(bad_timing, to_unsigned(0, 6));
              state <= idle_state;
            end if;
          end if;

        when copy_state =>

          leaving_address <= address;
          address         <= address + 1;
          if (address = shift_left(resize(checked.planes, 9), 2) - 1) then
            state <= verdict_state;
          end if;

        -- The last word leaves the memory and passes the check
        when verdict_state =>

          step <= step + 1;
          if (step = 4) then
            step    <= 0;
            state   <= idle_state;
            pending <= not refused;
          end if;

      end case;

      -- Check of the word that has left the memory
      check(1) <= '0';
      check(2) <= check(1);
      if (copied = '1') then
        if (copied_address(0) = '0' and unsigned(copied_word) > MAX_CODE) then
          refuse(bad_code, copied_address(7 downto 2));
        end if;
        if (copied_address(1 downto 0) = "01") then
          delay <= resize(unsigned(copied_word), 18) + LENS_GAP;
        end if;
        if (copied_address(1 downto 0) = "11") then
          check(1)      <= '1';
          settled_plane <= copied_address(7 downto 2);
          settle        <= resize(unsigned(copied_word), 18);
          if (unsigned(copied_word) < checked.lead) then
            settle <= resize(checked.lead, 18);
          end if;
        end if;
      end if;
      if (check(1) = '1') then
        needed        <= delay + settle;
        checked_plane <= settled_plane;
      end if;
      if (check(2) = '1' and needed > gap) then
        refuse(bad_timing, checked_plane);
      end if;

      -- A new polarity of the trigger is an edge: it waits for rest
      if (pending = '1' and state = idle_state and (idle = '1' or (boundary = '1' and checked.new_level = '0'))) then
        pending <= '0';
        apply   <= '1';
        bank    <= not bank;
      end if;

      if (commit = '1') then
        state   <= settings_state;
        address <= (others => '0');
        step    <= 0;
        pending <= '0';
        apply   <= '0';
        bank    <= bank;
        refused <= '0';
        leaving <= '0';
        copied  <= '0';
        check   <= "00";
      end if;

      if (reset = '1') then
        state   <= idle_state;
        step    <= 0;
        pending <= '0';
        refused <= '0';
        bank    <= '0';
        apply   <= '0';
        address <= (others => '0');
        leaving <= '0';
        copied  <= '0';
        check   <= "00";
      end if;
    end if;

  end process check_and_copy;

end architecture rtl;
