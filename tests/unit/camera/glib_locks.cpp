/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* GLib's locks are futexes, which the thread sanitizer does not see: it would take all that they guard for
 * races. Linked into a test, this stands before them and tells it. See tests/tsan.sh. */
#include <dlfcn.h>
#include <glib-object.h>
#include <sanitizer/tsan_interface.h>

namespace {

/* GLib's own function of this name. */
template <typename Function> Function *next(Function *, const char *name)
{
    return reinterpret_cast<Function *>(dlsym(RTLD_NEXT, name));
}

} // namespace

#define ACQUIRES(name, Lock)                                                                                 \
    void name(Lock *lock)                                                                                    \
    {                                                                                                        \
        static auto *const real = next(name, #name);                                                         \
        real(lock);                                                                                          \
        __tsan_acquire(lock);                                                                                \
    }
#define TRIES(name, Lock)                                                                                    \
    gboolean name(Lock *lock)                                                                                \
    {                                                                                                        \
        static auto *const real = next(name, #name);                                                         \
        const gboolean locked = real(lock);                                                                  \
        if (locked)                                                                                          \
            __tsan_acquire(lock);                                                                            \
        return locked;                                                                                       \
    }
#define RELEASES(name, Lock)                                                                                 \
    void name(Lock *lock)                                                                                    \
    {                                                                                                        \
        static auto *const real = next(name, #name);                                                         \
        __tsan_release(lock);                                                                                \
        real(lock);                                                                                          \
    }

extern "C" {

ACQUIRES(g_mutex_lock, GMutex)
TRIES(g_mutex_trylock, GMutex)
RELEASES(g_mutex_unlock, GMutex)
ACQUIRES(g_rec_mutex_lock, GRecMutex)
TRIES(g_rec_mutex_trylock, GRecMutex)
RELEASES(g_rec_mutex_unlock, GRecMutex)

void g_cond_wait(GCond *condition, GMutex *mutex)
{
    static auto *const real = next(g_cond_wait, "g_cond_wait");
    __tsan_release(mutex);
    real(condition, mutex);
    __tsan_acquire(mutex);
}

gboolean g_cond_wait_until(GCond *condition, GMutex *mutex, gint64 end)
{
    static auto *const real = next(g_cond_wait_until, "g_cond_wait_until");
    __tsan_release(mutex);
    const gboolean in_time = real(condition, mutex, end);
    __tsan_acquire(mutex);
    return in_time;
}

/* Who lets go last ends the object after all others. */
void g_object_unref(gpointer object)
{
    static auto *const real = next(g_object_unref, "g_object_unref");
    __tsan_release(object);
    __tsan_acquire(object);
    real(object);
}
}
