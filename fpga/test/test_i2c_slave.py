# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""i2c_slave against the model of a host, with a memory of words behind it."""

import random

import cocotb
from cocotb.triggers import FallingEdge, RisingEdge, ValueChange
from cocotb.utils import get_sim_time

import coverage
from entity import CLOCK_PS, OpenDrain, begin, cycles, cycles_until
from i2c_host import I2cHost, Nack

WORDS = 30
READ_ONLY = {0, 1, 3}
BIT_PS = 2_500_000


class Rig:
    def __init__(self, dut):
        self.dut = dut
        self.memory = [0x1000 + 0x101 * word for word in range(WORDS)]
        self.reads, self.writes = [], []
        self.scl = OpenDrain(dut.scl_in)
        self.sda = OpenDrain(dut.sda_in, dut.sda_low)
        self.host = I2cHost(self.scl.pull(), self.sda.pull(), self.sda, BIT_PS)
        for follow in (self._serve_reads, self._serve_writes, self._tell_writable):
            cocotb.start_soon(follow())
        coverage.watch("i2c_slave", dut.state)

    async def begin(self):
        await begin(self.dut, read_data=0, writable=1)
        await cycles(self.dut, 20)

    def word(self):
        return int(self.dut.word_number.value)

    async def _serve_reads(self):
        while True:
            await RisingEdge(self.dut.read)
            await cycles(self.dut, 1)
            word = self.word()
            self.reads.append(word)
            await cycles(self.dut, 2)
            self.dut.read_data.value = self.memory[word] if word < WORDS else 0xFFFF

    async def _serve_writes(self):
        while True:
            await RisingEdge(self.dut.write)
            await cycles(self.dut, 1)
            self.writes.append((self.word(), int(self.dut.write_data.value)))
            self.memory[self.word()] = self.writes[-1][1]

    async def _tell_writable(self):
        while True:
            await ValueChange(self.dut.word_number)
            self.dut.writable.value = int(self.word() not in READ_ONLY and self.word() < WORDS)


async def refused(action, byte):
    """The action is not acknowledged at this byte."""
    try:
        await action
    except Nack as nack:
        assert nack.args[0] == byte, f"refused at byte {nack.args[0]}, not {byte}"
        return
    raise AssertionError("not refused")


@cocotb.test()
async def words_are_written_and_read_low_byte_first(dut):
    rig = Rig(dut)
    await rig.begin()
    rng = random.Random(3)
    for _ in range(6):
        word, value = rng.choice([2, 5, 17, 29]), rng.randrange(0x10000)
        await rig.host.write_bytes([word, value & 0xFF, value >> 8])
        assert rig.writes[-1] == (word, value)
        assert await rig.host.read_word(word) == value
    assert len(rig.writes) == 6 and len(rig.reads) == 6


@cocotb.test()
async def i2c_block_goes_on_with_the_next_words(dut):
    rig = Rig(dut)
    await rig.begin()
    values = [0x1234, 0xFFFF, 0x0000, 0xA5C3, 0x8001]
    await rig.host.write_words(25, values)
    assert rig.writes == list(zip(range(25, 30), values))
    data = await rig.host.read_bytes(25, 10)
    assert [low | high << 8 for low, high in zip(data[::2], data[1::2])] == values
    assert rig.reads == [25, 26, 27, 28, 29], "a word was read that was not asked for"


@cocotb.test()
async def smbus_block_carries_its_count(dut):
    rig = Rig(dut)
    await rig.begin()
    values = [0x0102, 0x0304, 0x0506]
    await rig.host.write_block(10, values)
    assert rig.writes == [(10, 0x0102), (11, 0x0304), (12, 0x0506)]
    assert await rig.host.read_block(10) == rig.memory[10:26], "32 bytes at most"
    assert await rig.host.read_block(27) == rig.memory[27:30], "up to the last word"
    assert await rig.host.read_word(10) == 0x0102, "a word after a block"


@cocotb.test()
async def full_block_of_32_bytes(dut):
    rig = Rig(dut)
    await rig.begin()
    values = list(range(0x7000, 0x7010))
    await rig.host.write_block(4, values)
    assert rig.memory[4:20] == values


@cocotb.test()
async def what_does_not_exist_is_refused(dut):
    rig = Rig(dut)
    await rig.begin()
    for command in (WORDS, 127, 128 + WORDS, 255):
        await refused(rig.host.write_bytes([command, 1, 2]), 1)
    await refused(rig.host.write_word(3, 1), 2)
    await refused(rig.host.write_words(29, [1, 2]), 4)
    for count in (0, 1, 3, 34, 255):
        await refused(rig.host.write_bytes([0x80 | 10, count, 1, 2]), 2)
    await refused(rig.host.write_bytes([0x80 | 10, 2, 1, 2, 3]), 5)
    assert rig.writes == [(29, 1), (10, 0x0201)]
    other = I2cHost(rig.host.scl_low, rig.host.sda_low, rig.sda, BIT_PS, address=0x3D)
    await refused(other.write_word(10, 1), 0)
    await refused(other.read_bytes(10, 2), 0)
    assert await rig.host.read_bytes(29, 4) == [0x01, 0x00, 0xFF, 0xFF], "past the last word"


@cocotb.test()
async def broken_off_transfers_write_nothing(dut):
    rig = Rig(dut)
    await rig.begin()
    host = rig.host
    await host.write_bytes([10, 0x55])
    await host.start()
    for byte in (0x3C << 1, 10, 0x55):
        assert await host.send(byte)
    for bit in (1, 0, 1):
        await host.bit(bit)
    await host.stop()
    assert rig.writes == []
    await host.start()
    assert await host.send(0x3C << 1)
    assert await host.send(11)
    await host.start()
    assert await host.send(0x3C << 1)
    assert await host.send(12)
    assert await host.send(0x34) and await host.send(0x12)
    await host.stop()
    assert rig.writes == [(12, 0x1234)]


@cocotb.test()
async def data_changes_well_after_the_falling_clock(dut):
    rig = Rig(dut)
    await rig.begin()
    falls, moves = [], []

    async def follow_scl():
        while True:
            await FallingEdge(dut.scl_in)
            falls.append(get_sim_time("ps"))

    async def follow_sda():
        while True:
            await ValueChange(dut.sda_low)
            moves.append(get_sim_time("ps"))
            assert int(dut.scl_in.value) == 0, "SDA moves while SCL is high"
            assert 300_000 <= moves[-1] - falls[-1] <= 900_000

    cocotb.start_soon(follow_scl())
    follower = cocotb.start_soon(follow_sda())
    rig.memory[10] = 0x55AA
    assert await rig.host.read_word(10) == 0x55AA
    assert moves and not follower.done()


@cocotb.test()
async def transfer_that_stands_still_lets_go_of_the_bus(dut):
    rig = Rig(dut)
    await rig.begin()
    rig.memory[10] = 0
    host = rig.host
    await host.start()
    assert await host.send(0x3C << 1) and await host.send(10)
    await host.start()
    assert await host.send(0x3C << 1 | 1)
    await cycles(dut, 20)
    assert int(dut.sda_low.value) == 1
    taken = await cycles_until(dut, dut.sda_low, 0, 26_000_000_000 // CLOCK_PS)
    assert taken * CLOCK_PS > 24_000_000_000
    await host.stop()
    assert await host.read_word(11) == rig.memory[11]


async def read_on(host):
    """A word without a command before it: where the slave stands."""
    await host.start()
    assert await host.send(0x3C << 1 | 1)
    low, high = await host.receive(True), await host.receive(False)
    await host.stop()
    return high << 8 | low


@cocotb.test()
async def block_that_was_refused_is_forgotten(dut):
    rig = Rig(dut)
    await rig.begin()
    await rig.host.start()
    assert await rig.host.send(0x3C << 1) and await rig.host.send(0x80 | 10)
    assert not await rig.host.send(3), "an odd count"
    assert await read_on(rig.host) == rig.memory[10], "a word and not the count of a block"


@cocotb.test()
async def block_that_stood_still_is_forgotten(dut):
    rig = Rig(dut)
    await rig.begin()
    await rig.host.start()
    assert await rig.host.send(0x3C << 1) and await rig.host.send(0x80 | 10)
    await cycles(dut, 26_000_000_000 // CLOCK_PS)
    assert await read_on(rig.host) == rig.memory[10], "a word and not the count of a block"


@cocotb.test()
async def reset_releases_the_bus(dut):
    rig = Rig(dut)
    await rig.begin()
    await rig.host.start()
    assert await rig.host.send(0x3C << 1)
    dut.reset.value = 1
    await cycles(dut, 2)
    assert int(dut.sda_low.value) == 0
