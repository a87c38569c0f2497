/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Shared memory under x86's total store order: each process has a FIFO store buffer, which the
 * hardware drains at any time; a load finds the process's own buffered stores first. A model
 * defines before including this file:
 *   WORDS      words of shared memory
 *   PROCESSES  processes that store
 * and uses, where p is the process and a the word:
 *   load(p, a)               any load
 *   store_release(p, a, v)   a plain, relaxed or release store; may stay in the buffer
 *   store_seq_cst(p, a, v)   a store with a full fence (xchg)
 *   settled(p)               condition of a locked instruction (compare-and-swap, fetch-and-add)
 * A buffer of two stores suffices: one store is overtaken by a later load while another one waits.
 */
#define BUFFERED 2

byte memory[WORDS];
byte pending_word[PROCESSES * BUFFERED];
byte pending_value[PROCESSES * BUFFERED];
byte pending[PROCESSES];

#define is_pending(p, i, a) (pending[p] > i && pending_word[(p) * BUFFERED + i] == (a))
#define load(p, a) \
  (is_pending(p, 1, a) -> pending_value[(p) * BUFFERED + 1] : \
   (is_pending(p, 0, a) -> pending_value[(p) * BUFFERED] : memory[a]))
#define settled(p) (pending[p] == 0)

inline store_release(p, a, v) {
  d_step {
    pending[p] < BUFFERED ->
    pending_word[(p) * BUFFERED + pending[p]] = a;
    pending_value[(p) * BUFFERED + pending[p]] = v;
    pending[p]++
  }
}

inline store_seq_cst(p, a, v) {
  d_step { settled(p) -> memory[a] = v }
}

/* The store buffer of process p, drained by the hardware. */
proctype StoreBuffer(byte p) {
end:
  do
  :: d_step {
       pending[p] > 0 ->
       memory[pending_word[p * BUFFERED]] = pending_value[p * BUFFERED];
       pending_word[p * BUFFERED] = pending_word[p * BUFFERED + 1];
       pending_value[p * BUFFERED] = pending_value[p * BUFFERED + 1];
       pending_word[p * BUFFERED + 1] = 0;
       pending_value[p * BUFFERED + 1] = 0;
       pending[p]--;
       if
       :: pending[p] == 0 -> pending_word[p * BUFFERED] = 0; pending_value[p * BUFFERED] = 0
       :: else
       fi
     }
  od
}
