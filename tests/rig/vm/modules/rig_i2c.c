/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * An I2C bus with two slaves: at 0x3c the words of the sweep sequencer (fpga/registers.toml), at 0x77 the
 * bytes of a MAX14574. Takes I2C_RDWR and, through the kernel's emulation, SMBus. /proc/rig_i2c is the log of
 * what was written, a line a register: "3c 02=0001" (a word), "77 09=02" (a byte); writing to it empties it.
 * /proc/rig_lens tells when the lens was told what: a line a commit, nanoseconds of CLOCK_MONOTONIC and the
 * code, "12345678 512". The next `nack` transfers are not acknowledged. */
#include <linux/i2c.h>
#include <linux/ktime.h>
#include <linux/module.h>
#include <linux/mutex.h>
#include <linux/proc_fs.h>
#include <linux/seq_file.h>

#define SEQUENCER 0x3c
#define LENS 0x77
#define WORDS 0x1e
#define PLANE_SELECT 0x19 /* the words after it are a window on the row of that plane */
#define ROW_WORDS 4
#define ERROR 0x04
#define LOG_BYTES 65536
#define COMMITS 4096 /* that are kept: the last ones */
#define OIS_LSB 0x04
#define LLV4 0x08
#define COMMAND 0x09
#define UPDATE_OUTPUT 0x02

static int nack;
module_param(nack, int, 0644);

static DEFINE_MUTEX(lock); /* guards all below */
static u16 words[WORDS] = {[0x00] = 0xdff5, [0x01] = 0x0101, [0x0a] = 291, [0x0b] = 146};
static u16 rows[64][ROW_WORDS];
static u8 bytes[256];
static char log_text[LOG_BYTES];
static size_t log_length;
static struct {
    u64 time_ns;
    unsigned int code;
} commits[COMMITS];
static unsigned int commit_count;

static void log_write(unsigned int slave, unsigned int number, unsigned int value, int digits)
{
    log_length += scnprintf(log_text + log_length, LOG_BYTES - log_length, "%02x %02x=%0*x\n", slave, number,
                            digits, value);
}

static u16 *word(unsigned int number)
{
    if (number > PLANE_SELECT)
        return &rows[words[PLANE_SELECT] & 63][number - PLANE_SELECT - 1];
    return &words[number];
}

static int write_sequencer(const u8 *data, size_t length)
{
    unsigned int number = data[0] & 0x7f;
    size_t at = 1;

    if (data[0] & 0x80) { /* an SMBus block, with its count */
        if (length < 2 || data[1] != length - 2)
            return -ENXIO;
        at = 2;
    }
    if ((length - at) % 2)
        return -ENXIO;
    for (; at < length; at += 2, number++) {
        u16 value = data[at] | data[at + 1] << 8;

        if (number >= WORDS)
            return -ENXIO;
        log_write(SEQUENCER, number, value, 4);
        *word(number) = number == ERROR ? *word(number) & ~value : value;
    }
    return 0;
}

static int write_lens(const u8 *data, size_t length)
{
    size_t at;

    for (at = 1; at < length; at++) {
        u8 number = data[0] + at - 1;

        log_write(LENS, number, data[at], 2);
        bytes[number] = data[at];
        if (number == COMMAND && data[at] == UPDATE_OUTPUT) {
            commits[commit_count % COMMITS].time_ns = ktime_get_ns();
            commits[commit_count % COMMITS].code = bytes[LLV4] << 2 | bytes[OIS_LSB] >> 6;
            commit_count++;
        }
    }
    return 0;
}

static int read_slave(unsigned int slave, unsigned int number, u8 *data, size_t length)
{
    size_t at;

    for (at = 0; at < length; at++) {
        if (slave == LENS)
            data[at] = bytes[(number + at) & 0xff];
        else if (number + at / 2 >= WORDS)
            return -ENXIO;
        else
            data[at] = *word(number + at / 2) >> (at % 2 ? 8 : 0);
    }
    return 0;
}

static int transfer_locked(struct i2c_msg *messages, int count)
{
    u8 number = 0;
    int i, result = 0;

    if (nack > 0) {
        nack--;
        return -ENXIO;
    }
    for (i = 0; i < count && !result; i++) {
        struct i2c_msg *message = &messages[i];

        if (message->addr != SEQUENCER && message->addr != LENS)
            return -ENXIO;
        if (message->flags & I2C_M_RD) {
            result = read_slave(message->addr, number, message->buf, message->len);
        } else if (message->len) {
            number = message->buf[0];
            result = message->addr == LENS ? write_lens(message->buf, message->len)
                                           : write_sequencer(message->buf, message->len);
        }
    }
    return result ? result : count;
}

static int transfer(struct i2c_adapter *adapter, struct i2c_msg *messages, int count)
{
    int result;

    mutex_lock(&lock);
    result = transfer_locked(messages, count);
    mutex_unlock(&lock);
    return result;
}

static u32 functionality(struct i2c_adapter *adapter)
{
    return I2C_FUNC_I2C | I2C_FUNC_SMBUS_EMUL;
}

static const struct i2c_algorithm algorithm = {.master_xfer = transfer, .functionality = functionality};
static struct i2c_adapter adapter = {.owner = THIS_MODULE, .algo = &algorithm, .name = "rig_i2c"};

static int show_log(struct seq_file *file, void *unused)
{
    mutex_lock(&lock);
    seq_write(file, log_text, log_length);
    mutex_unlock(&lock);
    return 0;
}

static int open_log(struct inode *inode, struct file *file)
{
    return single_open(file, show_log, NULL);
}

static ssize_t empty_log(struct file *file, const char __user *data, size_t length, loff_t *offset)
{
    mutex_lock(&lock);
    log_length = 0;
    mutex_unlock(&lock);
    return length;
}

static const struct proc_ops log_operations = {
    .proc_open = open_log,
    .proc_read = seq_read,
    .proc_lseek = seq_lseek,
    .proc_release = single_release,
    .proc_write = empty_log,
};

static int show_lens(struct seq_file *file, void *unused)
{
    unsigned int at;

    mutex_lock(&lock);
    for (at = commit_count > COMMITS ? commit_count - COMMITS : 0; at < commit_count; at++)
        seq_printf(file, "%llu %u\n", commits[at % COMMITS].time_ns, commits[at % COMMITS].code);
    mutex_unlock(&lock);
    return 0;
}

static int __init rig_i2c_init(void)
{
    int result = i2c_add_adapter(&adapter);

    if (!result && (!proc_create("rig_i2c", 0600, NULL, &log_operations) ||
                    !proc_create_single("rig_lens", 0400, NULL, show_lens))) {
        i2c_del_adapter(&adapter);
        result = -ENOMEM;
    }
    return result;
}

static void __exit rig_i2c_exit(void)
{
    remove_proc_entry("rig_lens", NULL);
    remove_proc_entry("rig_i2c", NULL);
    i2c_del_adapter(&adapter);
}

module_init(rig_i2c_init);
module_exit(rig_i2c_exit);
MODULE_LICENSE("GPL");
MODULE_DESCRIPTION("I2C bus with the registers of a sweep sequencer and a lens driver");
