/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: is the memory of a subscription freed only when no publisher and no receive thread can
 * still push to it, and is it always freed in the end, although they are killed?
 *
 * Closing is two stores under the registry lock: the row is closed, `changes` is raised. Publisher
 * and receive thread each keep a private list of the topic's rows, and renew it in their phase when
 * `changes` moved. The process that frees has to see each of them out of its phase once after that;
 * what it has seen it keeps to itself, so another process begins anew. A publisher whose row is
 * closed follows nothing. The publisher may be killed at any step and is then reaped. So may the
 * receive thread, which is replaced if its cluster has a process left, and the process that closes.
 * The next owner of the registry lock repairs: it raises `changes` of each bucket, as its
 * predecessor may have died between the two stores. A subscription of a dead process that is not
 * closed yet is closed by its reaper, which may get the lock later.
 *
 * RUN MESSAGES=1 KILLS=3 (long)
 * RUN MESSAGES=2 KILLS=1
 * BUG 1: freed without waiting for the phases
 * BUG 2: publisher: no fence between phase and the load of changes
 * BUG 3: publisher renews its list before its phase is odd
 * BUG 4: receive thread: no fence between phase and the load of changes
 * BUG 5: phases checked before the row is closed
 * BUG 6 (reversed): changes not raised
 * BUG 7: a closed publisher's phase is waited for
 * BUG 8: a new receive thread does not end the phase of its predecessor
 * BUG 9: publisher's phase is even before its last push
 * BUG 10: the process that frees waits for a dead receive thread that has no successor
 * BUG 11: a receive thread counts as dead once its lifeline ends, not once it has stopped
 * BUG 12: a repair does not raise changes
 * BUG 13 MESSAGES=2 KILLS=1 (reversed): changes raised before the row is closed
 * BUG 14 MESSAGES=2 KILLS=1 (reversed): walk along the chain before changes is loaded
 * BUG 15: a killed publisher's row is closed before the process has stopped
 * BUG 16: the successor of a receive thread takes over its list as renewed
 */
#define CHANGES 0         /* of the topic's bucket */
#define LIVE 1            /* row of the subscription */
#define PHASE(p) (2 + (p))
#define WORDS 4
#define PROCESSES 3
#define PUBLISHER 0
#define RECEIVER 1
#define CLOSER 2

#include "tso.pml"

bool freed;
bool kill_publisher, kill_receiver, kill_closer;
bool publisher_ended, receiver_ended, closer_ended;
bool publisher_lives = true;   /* its row is live */
bool receiver_lives = true;    /* its lifeline is held */

/* Phases count up in C++; here they alternate between 0 and 1. */
inline enter(p) {
  if
  :: BUG == 2 + 2 * p -> store_release(p, PHASE(p), 1)
  :: else -> store_seq_cst(p, PHASE(p), 1)
  fi
}

inline leave(p) {
  store_release(p, PHASE(p), 0)
}

/* Each step inside a push accesses the queue; one step stands for all. */
inline push() {
  assert(!freed)
}

inline refresh(p) {
#if BUG == 14
  was_live = load(p, LIVE);
#endif
  now = load(p, CHANGES);
  if
  :: now != seen ->
#if BUG == 14
     listed = was_live;
#else
     listed = load(p, LIVE);
#endif
     seen = now
  :: else
  fi
}

proctype Publisher() {
  byte now, seen, message;
  bool was_live;
  bool listed = true;      /* has published before */
  {
    do
    :: message < MESSAGES ->
       message++;
#if BUG == 3
       refresh(PUBLISHER);
#endif
       enter(PUBLISHER);
#if BUG != 3
       refresh(PUBLISHER);
#endif
#if BUG == 9
       leave(PUBLISHER);
#endif
       if
       :: listed -> push()
       :: else
       fi;
#if BUG != 9
       leave(PUBLISHER)
#endif
    :: break              /* silent forever */
    od
  } unless { kill_publisher };
  publisher_ended = true
}

/* A successor knows nothing: its list is outdated. */
proctype ReceiveThread(bool is_successor) {
  byte now, seen, message;
  bool was_live;
  bool listed = true;
  if
  :: is_successor && BUG != 16 -> seen = 255
  :: is_successor && BUG == 16 -> seen = load(RECEIVER, CHANGES)
  :: else
  fi;
  {
    do
    :: message < MESSAGES ->
       message++;
       enter(RECEIVER);
       refresh(RECEIVER);
       if
       :: listed -> push()
       :: else
       fi;
       leave(RECEIVER)
    :: break              /* silent forever */
    od
  } unless { kill_receiver };
  receiver_ended = true
}

/* Kills and reaps, or not. A dead process executes no steps, but its stores still become visible.
 * */
proctype Reaper() {
  if
  ::
#if BUG == 15
     publisher_lives = false;
#endif
     KILLS > 1 -> kill_publisher = true;
     publisher_ended && settled(PUBLISHER);
     publisher_lives = false
  :: skip
  fi
}

proctype Successor() {
  if
  ::
#if BUG == 11
     receiver_lives = false;
#endif
     KILLS > 1 -> kill_receiver = true;
     receiver_ended && settled(RECEIVER);
     receiver_lives = false;
     if
     :: receiver_lives = true;
#if BUG != 8
        memory[PHASE(RECEIVER)] = 0;
#endif
        kill_receiver = false;
        run ReceiveThread(true)
     :: skip               /* the cluster has no process left */
     fi
  :: skip
  fi
}

#if BUG == 7
#define publisher_is_out() (load(CLOSER, PHASE(PUBLISHER)) == 0)
#else
#define publisher_is_out() (load(CLOSER, PHASE(PUBLISHER)) == 0 || !publisher_lives)
#endif
#if BUG == 10
#define receiver_is_out() (load(CLOSER, PHASE(RECEIVER)) == 0)
#else
#define receiver_is_out() (load(CLOSER, PHASE(RECEIVER)) == 0 || !receiver_lives)
#endif

inline raise() {
  d_step { settled(CLOSER) -> memory[CHANGES]++ }
}

inline close() {
#if BUG == 13
  raise();
#endif
  store_release(CLOSER, LIVE, 0);
#if BUG != 6 && BUG != 13
  raise()
#endif
}

inline free_when_out() {
  settled(CLOSER);
#if BUG != 1 && BUG != 5
  publisher_is_out();
  receiver_is_out();
#endif
  freed = true
}

proctype Closer() {
  {
#if BUG == 5
    publisher_is_out();
    receiver_is_out();
#endif
    close();
    free_when_out()
  } unless { kill_closer };
  closer_ended = true
}

/* Kills the closer, or not. Runs the next owner of the registry lock, which may not know yet that
 * the closer is dead, and after it the reaper, which closes once more. */
proctype NextOwners() {
  if
  :: KILLS > 0 -> kill_closer = true;
     closer_ended && settled(CLOSER);
#if BUG != 12
     raise();
#endif
     if
     :: !load(CLOSER, LIVE) -> free_when_out()
     :: else -> close(); free_when_out()
     fi
  :: skip
  fi
}

/* A phase that stays odd forever keeps Closer from its end: spin reports an invalid end state. */
init {
  atomic {
    memory[LIVE] = 1;
    run StoreBuffer(PUBLISHER); run StoreBuffer(RECEIVER); run StoreBuffer(CLOSER);
    run Publisher(); run ReceiveThread(false); run Reaper(); run Successor(); run Closer();
    run NextOwners()
  }
}
