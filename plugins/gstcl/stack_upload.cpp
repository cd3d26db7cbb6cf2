/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/stack_upload.h"

#include <gst/dff/dff.h>
#include <gst/dff/private/gstfocalstackshared.h>

namespace dff {

namespace {

/* The upload of a memory, which stays as it was: a second exclusive lock beside its buffer's makes it shared,
 * and shared memory is copied before it is written. */
struct MemoryUpload {
    explicit MemoryUpload(GstMemory *locked)
        : memory(gst_memory_ref(locked)), upload(std::make_shared<SharedUpload>())
    {
    }
    ~MemoryUpload()
    {
        upload.reset(); /* which reads the memory until it is done */
        gst_memory_unlock(memory, GST_LOCK_FLAG_EXCLUSIVE);
        gst_memory_unref(memory);
    }
    MemoryUpload(const MemoryUpload &) = delete;
    MemoryUpload &operator=(const MemoryUpload &) = delete;

    GstMemory *memory;
    std::shared_ptr<SharedUpload> upload;
};

} // namespace

std::shared_ptr<SharedUpload> shared_upload(GstBuffer *stack)
{
    const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack);
    if (!meta || gst_buffer_n_memory(stack) != 1)
        return nullptr;

    GstMemory *memory = gst_buffer_peek_memory(stack, 0);
    auto *shared = static_cast<GstFocalStackShared *>(meta->shared);
    g_autoptr(GMutexLocker) locker = g_mutex_locker_new(&shared->mutex);
    const auto *held = static_cast<MemoryUpload *>(shared->data);
    if (held && held->memory == memory)
        return held->upload;
    if (!gst_memory_lock(memory, GST_LOCK_FLAG_EXCLUSIVE))
        return nullptr;
    auto upload = std::make_unique<MemoryUpload>(memory);
    std::shared_ptr<SharedUpload> result = upload->upload;
    gst_focal_stack_shared_set(shared, upload.release(),
                               [](gpointer data) { delete static_cast<MemoryUpload *>(data); });
    return result;
}

} // namespace dff
