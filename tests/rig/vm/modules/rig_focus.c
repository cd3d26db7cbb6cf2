/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Gives a vivid camera the focus controls it lacks. The lens can be moved only while autofocus is off. It is
 * there `move_ms` after it was told, and then its position is the picture's brightness, so that every frame
 * shows where the lens was. */
#include <linux/fs.h>
#include <linux/module.h>
#include <linux/workqueue.h>
#include <media/v4l2-ctrls.h>
#include <media/v4l2-dev.h>

static char *device = "/dev/video0";
module_param(device, charp, 0444);
static int move_ms = 60;
module_param(move_ms, int, 0644);

static struct v4l2_ctrl *autofocus, *focus, *brightness;
static int position;

static void arrive(struct work_struct *work)
{
    v4l2_ctrl_s_ctrl(brightness, position);
}

static DECLARE_DELAYED_WORK(arrival, arrive);

static int set_control(struct v4l2_ctrl *control)
{
    if (control->id == V4L2_CID_FOCUS_ABSOLUTE) {
        if (autofocus && autofocus->cur.val)
            return -EBUSY;
        position = control->val;
        mod_delayed_work(system_wq, &arrival, msecs_to_jiffies(move_ms));
    }
    return 0;
}

static const struct v4l2_ctrl_ops operations = {.s_ctrl = set_control};

static int __init rig_focus_init(void)
{
    struct file *file = filp_open(device, O_RDWR, 0);
    struct v4l2_ctrl_handler *handler;

    if (IS_ERR(file))
        return PTR_ERR(file);
    handler = video_devdata(file)->ctrl_handler;
    brightness = v4l2_ctrl_find(handler, V4L2_CID_BRIGHTNESS);
    autofocus = v4l2_ctrl_new_std(handler, &operations, V4L2_CID_FOCUS_AUTO, 0, 1, 1, 1);
    focus = v4l2_ctrl_new_std(handler, &operations, V4L2_CID_FOCUS_ABSOLUTE, 40, 220, 10, 130);
    filp_close(file, NULL);
    return brightness && autofocus && focus ? 0 : -ENODEV;
}

/* The controls belong to vivid from now on: no exit, so the module stays. */
module_init(rig_focus_init);
MODULE_LICENSE("GPL");
MODULE_DESCRIPTION("Focus controls for vivid");
