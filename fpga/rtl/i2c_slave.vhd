-- SPDX-License-Identifier: LGPL-2.1-or-later
-- Copyright (C) 2026 the gst-plugins-dff authors
--
-- The host's way to the words: SMBus word access (command k), SMBus blocks (command 128 + k) and I2C blocks.
-- It never stretches the clock, so it works while the lens bus is busy.

library ieee;
  use ieee.std_logic_1164.all;
  use ieee.numeric_std.all;

library work;
  use work.timing_pkg.all;

entity i2c_slave is
  generic (
    CLOCK_HZ   : positive := 125_000_000;
    ADDRESS    : natural  := 16#3C#;
    WORD_COUNT : positive := 30;
    -- SDA changes this long after the falling edge of SCL
    HOLD_S : real := 300.0e-9;
    -- A transfer that stands still for longer is given up (SMBus: 25 ms)
    TIMEOUT_S : real := 25.0e-3
  );
  port (
    clk   : in    std_ulogic;
    reset : in    std_ulogic;
    -- The bus, synchronised; '1' on sda_low pulls the line low
    scl_in  : in    std_ulogic;
    sda_in  : in    std_ulogic;
    sda_low : out   std_ulogic;
    -- The words; read_data is taken from four cycles after read on
    word_number : out   unsigned(6 downto 0);
    writable    : in    std_ulogic;
    read        : out   std_ulogic;
    read_data   : in    std_ulogic_vector(15 downto 0);
    write       : out   std_ulogic;
    write_data  : out   std_ulogic_vector(15 downto 0)
  );
end entity i2c_slave;

architecture rtl of i2c_slave is

  constant HOLD_CYCLES     : positive := to_cycles(CLOCK_HZ, HOLD_S);
  constant TIMEOUT_CYCLES  : positive := to_cycles(CLOCK_HZ, TIMEOUT_S);
  constant MAX_BLOCK_BYTES : positive := 32;

  type state_t is (idle_state, receive_state, acknowledge_state, send_state, master_acknowledge_state);

  -- What the byte in hand is

  type byte_t is (address_byte, command_byte, count_byte, low_byte, high_byte);

  signal state     : state_t;
  signal what      : byte_t;
  signal scl_last  : std_ulogic;
  signal sda_last  : std_ulogic;
  signal bit_count : natural range 0 to 8;
  signal shifter   : std_ulogic_vector(7 downto 0);
  signal reading   : std_ulogic;
  signal word      : natural range 0 to 127;
  signal block_on  : std_ulogic;
  -- Bytes left of a block write; 0 outside of a block
  signal remaining : natural range 0 to MAX_BLOCK_BYTES;
  signal low_data  : std_ulogic_vector(7 downto 0);
  signal high_data : std_ulogic_vector(7 downto 0);
  signal drive_low : std_ulogic;
  signal pull      : std_ulogic;
  signal hold      : natural range 0 to HOLD_CYCLES - 1;
  signal quiet     : natural range 0 to TIMEOUT_CYCLES;

  function count_is_valid (
    byte : std_ulogic_vector(7 downto 0)
  ) return boolean is
  begin

    return byte(0) = '0' and unsigned(byte) /= 0 and unsigned(byte) <= MAX_BLOCK_BYTES;

  end function count_is_valid;

  function next_word (
    from_word : natural range 0 to 127
  ) return natural is
  begin

    if (from_word = 127) then
      return 127;
    end if;

    return from_word + 1;

  end function next_word;

  -- Bytes that a block read from a word on gives

  function block_bytes (
    from_word : natural range 0 to 127
  ) return natural is
  begin

    if (from_word + MAX_BLOCK_BYTES / 2 <= WORD_COUNT) then
      return MAX_BLOCK_BYTES;
    elsif (from_word < WORD_COUNT) then
      return WORD_COUNT - from_word + WORD_COUNT - from_word;
    end if;

    return 0;

  end function block_bytes;

begin

  word_number <= to_unsigned(word, 7);
  sda_low     <= pull;

  transfer : process (clk) is

    variable rise   : boolean;
    variable fall   : boolean;
    variable accept : boolean;

    procedure send_byte (
      byte : std_ulogic_vector(7 downto 0)
    ) is
    begin

      state     <= send_state;
      shifter   <= byte(6 downto 0) & '1';
      drive_low <= not byte(7);
      bit_count <= 0;

    end procedure send_byte;

  begin

    if rising_edge(clk) then
      scl_last <= scl_in;
      sda_last <= sda_in;
      read     <= '0';
      write    <= '0';

      rise := scl_in = '1' and scl_last = '0';
      fall := scl_in = '0' and scl_last = '1';

      case state is

        -- Nothing of a transfer is left, however it ended
        when idle_state =>

          drive_low <= '0';
          block_on  <= '0';
          remaining <= 0;

        when receive_state =>

          if (rise) then
            shifter   <= shifter(6 downto 0) & sda_in;
            bit_count <= bit_count + 1;
          elsif (fall and bit_count = 8) then

            case what is

              when address_byte =>

                accept  := unsigned(shifter(7 downto 1)) = ADDRESS;
                reading <= shifter(0);
                if (accept and shifter(0) = '1') then
                  read <= '1';
                end if;

              when command_byte =>

                accept   := unsigned(shifter(6 downto 0)) < WORD_COUNT;
                word     <= to_integer(unsigned(shifter(6 downto 0)));
                block_on <= shifter(7);

              when count_byte =>

                accept := count_is_valid(shifter);
                if (accept) then
                  remaining <= to_integer(unsigned(shifter(5 downto 0)));
                end if;

              when low_byte =>

                accept   := writable = '1' and word < WORD_COUNT and not (block_on = '1' and remaining = 0);
                low_data <= shifter;

              when high_byte =>

                accept     := true;
                write      <= '1';
                write_data <= shifter & low_data;

            end case;

            bit_count <= 0;
            if (accept) then
              state     <= acknowledge_state;
              drive_low <= '1';
            else
              state <= idle_state;
            end if;
          end if;

        -- The acknowledge ends: on to the next byte
        when acknowledge_state =>

          if (fall) then
            drive_low <= '0';
            state     <= receive_state;

            case what is

              when address_byte =>

                if (reading = '0') then
                  what <= command_byte;
                else
                  low_data  <= read_data(7 downto 0);
                  high_data <= read_data(15 downto 8);
                  if (block_on = '1') then
                    what <= count_byte;
                    send_byte(std_ulogic_vector(to_unsigned(block_bytes(word), 8)));
                  else
                    what <= low_byte;
                    send_byte(read_data(7 downto 0));
                  end if;
                end if;

              when command_byte =>

                if (block_on = '1') then
                  what <= count_byte;
                else
                  what <= low_byte;
                end if;

              when count_byte =>

                what <= low_byte;

              when low_byte =>

                what <= high_byte;

              when high_byte =>

                what <= low_byte;
                word <= next_word(word);
                if (block_on = '1') then
                  remaining <= remaining - 2;
                end if;

            end case;

          end if;

        when send_state =>

          if (fall) then
            shifter   <= shifter(6 downto 0) & '1';
            drive_low <= not shifter(7);
            bit_count <= bit_count + 1;
            if (bit_count = 7) then
              drive_low <= '0';
              state     <= master_acknowledge_state;
            end if;
          end if;

        when master_acknowledge_state =>

          if (rise) then
            if (sda_in = '1') then
              state <= idle_state;
            elsif (what = high_byte) then
              word <= next_word(word);
              read <= '1';
            end if;
          elsif (fall) then

            case what is

              when count_byte =>

                what <= low_byte;
                send_byte(low_data);

              when low_byte =>

                what <= high_byte;
                send_byte(high_data);

              when others =>

                what      <= low_byte;
                high_data <= read_data(15 downto 8);
                send_byte(read_data(7 downto 0));

            end case;

          end if;

      end case;

      -- Start and stop: SDA moves while SCL is high
      if (scl_in = '1' and scl_last = '1') then
        if (sda_in = '0' and sda_last = '1') then
          state     <= receive_state;
          what      <= address_byte;
          bit_count <= 0;
          drive_low <= '0';
        elsif (sda_in = '1' and sda_last = '0') then
          state <= idle_state;
        end if;
      end if;

      if (rise or fall or state = idle_state) then
        quiet <= 0;
      elsif (quiet = TIMEOUT_CYCLES) then
        state <= idle_state;
      else
        quiet <= quiet + 1;
      end if;

      if (reset = '1') then
        state     <= idle_state;
        what      <= address_byte;
        scl_last  <= '1';
        sda_last  <= '1';
        drive_low <= '0';
        word      <= 0;
        block_on  <= '0';
        remaining <= 0;
        quiet     <= 0;
      end if;
    end if;

  end process transfer;

  hold_data : process (clk) is
  begin

    if rising_edge(clk) then
      if (drive_low = pull) then
        hold <= 0;
      elsif (hold = HOLD_CYCLES - 1) then
        pull <= drive_low;
      else
        hold <= hold + 1;
      end if;

      if (reset = '1') then
        pull <= '0';
        hold <= 0;
      end if;
    end if;

  end process hold_data;

end architecture rtl;
