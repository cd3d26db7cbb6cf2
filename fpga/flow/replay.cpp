/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */

/* Replays a trace of the pins on a mapped netlist: what the netlist shows at each clock edge must be what the
 * trace has.
 *
 *     replay NETLIST TRACE
 *
 * A line of the trace is the number of an edge, from 0, and the pins at it, in the order of Replay's
 * constructor. They stay so until the edge of the next line. On a pin of a bus '0' is the design's own pull,
 * 'L' another's. What the trace does not know ('U') is not compared.
 *
 * The netlist (simulate.py writes it) has gates of up to three inputs, each with its truth table, flip-flops
 * and block RAMs, in lines of a letter and numbers of nets. Only what hangs on a net that has changed is
 * worked out again. */
#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

struct Gate {
    unsigned table;
    std::array<unsigned, 3> inputs;
    unsigned output;
    unsigned depth;
    bool queued;
};

struct FlipFlop {
    unsigned input;
    unsigned output;
    bool queued;
};

/* The nets: write, two lanes, 10 of the address, 18 of data; read, 10 of the address, 18 of data. */
struct BlockRam {
    std::vector<unsigned> nets;
    std::vector<std::uint32_t> words = std::vector<std::uint32_t>(1024);
};

constexpr unsigned none = ~0U;

/* From here on pins are compared. Before the reset at power-up is over (10 clocks) the simulation of the design has
 * unknown values, where a netlist begins with zeros. */
constexpr std::uint64_t first_compared = 16;

class Netlist {
public:
    explicit Netlist(std::istream &text)
    {
        std::string line;
        while (std::getline(text, line)) {
            std::istringstream fields(line);
            read(fields);
        }
        connect();
    }

    unsigned net(const std::string &port, bool input) const
    {
        for (const auto &[name, is_input, number] : ports_) {
            if (name == port && is_input == input) {
                return number;
            }
        }
        return none;
    }

    bool value(unsigned net) const { return values_[net]; }

    void set(unsigned net, bool value)
    {
        if (values_[net] == value) {
            return;
        }
        values_[net] = value;
        for (const auto gate : readers_[net]) {
            queue(gate);
        }
        for (const auto flip_flop : registers_[net]) {
            if (!flip_flops_[flip_flop].queued) {
                flip_flops_[flip_flop].queued = true;
                due_.push_back(flip_flop);
            }
        }
    }

    void settle()
    {
        for (auto &level : levels_) {
            for (std::size_t index = 0; index < level.size(); ++index) {
                Gate &gate = gates_[level[index]];
                gate.queued = false;
                const auto [a, b, c] = gate.inputs;
                const unsigned row =
                    unsigned{values_[a]} | unsigned{values_[b]} << 1 | unsigned{values_[c]} << 2;
                set(gate.output, (gate.table >> row & 1) != 0);
            }
            level.clear();
        }
    }

    void clock()
    {
        std::vector<std::pair<unsigned, bool>> changes;
        for (const auto index : due_) {
            FlipFlop &flip_flop = flip_flops_[index];
            flip_flop.queued = false;
            changes.emplace_back(flip_flop.output, values_[flip_flop.input]);
        }
        due_.clear();
        for (auto &ram : rams_) {
            clock(ram, changes);
        }
        for (const auto &[net, value] : changes) {
            set(net, value);
        }
    }

private:
    struct Port {
        std::string name;
        bool input;
        unsigned net;
    };

    void read(std::istream &fields)
    {
        char kind = 0;
        fields >> kind;
        if (kind == 'n') {
            std::size_t count = 0;
            fields >> count;
            values_.resize(count);
            values_[1] = true;
        } else if (kind == 'i' || kind == 'o') {
            Port port{"", kind == 'i', 0};
            fields >> port.name >> port.net;
            ports_.push_back(port);
        } else if (kind == 'g') {
            Gate gate{};
            fields >> gate.table >> gate.inputs[0] >> gate.inputs[1] >> gate.inputs[2] >> gate.output >>
                gate.depth;
            gates_.push_back(gate);
        } else if (kind == 'f') {
            FlipFlop flip_flop{};
            bool initial = false;
            fields >> flip_flop.input >> flip_flop.output >> initial;
            values_[flip_flop.output] = initial;
            flip_flops_.push_back(flip_flop);
        } else if (kind == 'r') {
            BlockRam ram;
            for (unsigned net = 0; fields >> net;) {
                ram.nets.push_back(net);
            }
            rams_.push_back(ram);
        }
    }

    void connect()
    {
        readers_.resize(values_.size());
        registers_.resize(values_.size());
        for (unsigned index = 0; index < gates_.size(); ++index) {
            levels_.resize(std::max<std::size_t>(levels_.size(), gates_[index].depth + 1));
            for (const auto input : gates_[index].inputs) {
                readers_[input].push_back(index);
            }
            queue(index);
        }
        for (unsigned index = 0; index < flip_flops_.size(); ++index) {
            registers_[flip_flops_[index].input].push_back(index);
            flip_flops_[index].queued = true;
            due_.push_back(index);
        }
    }

    void queue(unsigned index)
    {
        Gate &gate = gates_[index];
        if (!gate.queued) {
            gate.queued = true;
            levels_[gate.depth].push_back(index);
        }
    }

    unsigned number(const BlockRam &ram, std::size_t first, std::size_t count) const
    {
        unsigned found = 0;
        for (std::size_t bit = 0; bit < count; ++bit) {
            found |= unsigned{values_[ram.nets[first + bit]]} << bit;
        }
        return found;
    }

    void clock(BlockRam &ram, std::vector<std::pair<unsigned, bool>> &changes)
    {
        if (values_[ram.nets[31]]) {
            const auto word = ram.words[number(ram, 32, 10)];
            for (unsigned bit = 0; bit < 18; ++bit) {
                changes.emplace_back(ram.nets[42 + bit], (word >> bit & 1) != 0);
            }
        }
        if (values_[ram.nets[0]]) {
            const std::uint32_t lanes =
                (values_[ram.nets[1]] ? 0x1ffU : 0U) | (values_[ram.nets[2]] ? 0x3fe00U : 0U);
            auto &word = ram.words[number(ram, 3, 10)];
            word = (word & ~lanes) | (number(ram, 13, 18) & lanes);
        }
    }

    std::vector<std::uint8_t> values_;
    std::vector<Port> ports_;
    std::vector<Gate> gates_;
    std::vector<FlipFlop> flip_flops_;
    std::vector<BlockRam> rams_;
    std::vector<std::vector<unsigned>> readers_;
    std::vector<std::vector<unsigned>> registers_;
    std::vector<std::vector<unsigned>> levels_;
    std::vector<unsigned> due_;
};

class Replay {
public:
    explicit Replay(Netlist &netlist) : netlist_(netlist)
    {
        for (const std::string name : {"reset_button", "run", "host_scl", "host_sda", "lens_scl", "lens_sda",
                                       "sync", "trigger", "busy", "error"}) {
            const unsigned low = netlist.net(name + "_pulled", false);
            names_.push_back(name);
            inputs_.push_back(netlist.net(name, true));
            outputs_.push_back(low != none ? low : netlist.net(name, false));
            buses_.push_back(low != none);
        }
    }

    /* False, and says why, if the netlist shows other pins. */
    bool edge(std::uint64_t number, const std::string &pins)
    {
        for (std::size_t pin = 0; pin < pins.size(); ++pin) {
            if (inputs_[pin] != none) {
                netlist_.set(inputs_[pin], pins[pin] == '1' || pins[pin] == 'H');
            }
        }
        netlist_.settle();
        for (std::size_t pin = 0; pin < pins.size(); ++pin) {
            if (number < first_compared || outputs_[pin] == none || pins[pin] == 'U' || pins[pin] == 'X') {
                continue;
            }
            const bool expected = pins[pin] == (buses_[pin] ? '0' : '1');
            if (netlist_.value(outputs_[pin]) != expected) {
                std::cout << "edge " << number << ": " << names_[pin] << (buses_[pin] ? " pulled low" : "")
                          << " should be " << expected << "\n";
                return false;
            }
        }
        netlist_.clock();
        return true;
    }

private:
    Netlist &netlist_;
    std::vector<std::string> names_;
    std::vector<unsigned> inputs_;
    std::vector<unsigned> outputs_;
    std::vector<bool> buses_;
};

} // namespace

int main(int count, char **arguments)
{
    if (count != 3) {
        std::cerr << "replay NETLIST TRACE\n";
        return 2;
    }
    std::ifstream text(arguments[1]);
    std::ifstream trace(arguments[2]);
    Netlist netlist(text);
    Replay replay(netlist);
    std::uint64_t number = 0;
    std::uint64_t next = 0;
    std::string pins;
    std::string next_pins;
    while (trace >> next >> next_pins) {
        for (; number < next; ++number) {
            if (!replay.edge(number, pins)) {
                return 1;
            }
        }
        pins = next_pins;
    }
    if (number == 0 || !replay.edge(number, pins)) {
        return 1;
    }
    std::cout << number + 1 << " clocks agree\n";
    return 0;
}
