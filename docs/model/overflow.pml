/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a subscription in another cluster learn of each message, although eMCOS messages
 * are dropped when its cluster's pipe is full? And never of an earlier message after a later one,
 * which would make it skip the earlier one?
 *
 * Follows notifier.cpp (announce, request_resync), ReceiveThread::run and RecordFinder::next. For
 * wake-ups see waiting.pml: here the subscriber checks if and only if its epoch was incremented.
 *
 * BUG 1: resync set after pipe_overflow
 * BUG 2: pipe_overflow checked before the pipe is read, not after
 * BUG 3: no eMCOS message sent after pipe_overflow is set
 * BUG 4: pipe_overflow cleared after the processes are woken
 * BUG 5: subscriber clears resync after its scan
 * BUG 6: publisher relies on the full pipe alone
 * BUG 7: resync not checked again after a hint was popped
 */
#define MESSAGES 2
#define PUBLISHERS 2
#define CAPACITY 1        /* eMCOS messages in the pipe */

chan pipe = [CAPACITY] of { byte, byte };   /* publisher; record number, 0 = kind resync */
byte last[PUBLISHERS];    /* published so far */
chan queue = [PUBLISHERS * MESSAGES] of { byte, byte };
byte noted[PUBLISHERS];   /* taken up to here */
bool resync, pipe_overflow;
bool woken;               /* epoch incremented since the subscriber's last check */

/* Each store here has a full fence, or is a system call. */
proctype Publisher(byte i) {
  do
  :: last[i] < MESSAGES ->
     last[i]++;
     if
     :: atomic { nfull(pipe) -> pipe!i, last[i] }
     :: full(pipe) ->
#if BUG == 1
        pipe_overflow = true;
        resync = true;
#elif BUG == 6
        resync = true;
#else
        resync = true;
        pipe_overflow = true;
#endif
#if BUG != 3
        if
        :: atomic { nfull(pipe) -> pipe!i, 0 }
        :: full(pipe)
        fi
#endif
     fi
  :: last[i] == MESSAGES -> break
  od
}

inline look_after_overflow() {
  if
  :: pipe_overflow ->
#if BUG == 4
     woken = true;
     pipe_overflow = false
#else
     pipe_overflow = false;
     woken = true
#endif
  :: else
  fi
}

proctype ReceiveThread() {
  byte i, n;
end:
  do
  :: nempty(pipe) ->
#if BUG == 2
     look_after_overflow();
#endif
     pipe?i, n;
     if
     :: n > 0 -> queue!i, n; woken = true
     :: else
     fi;
     i = 0; n = 0;
#if BUG != 2
     look_after_overflow()
#endif
  od
}

inline look_at_everything() {
#if BUG != 5
  resync = false;
#endif
  noted[0] = last[0];
  noted[1] = last[1];
#if BUG == 5
  resync = false
#endif
}

inline take() {
  atomic {
    assert(n <= noted[i] + 1);
    noted[i] = (n > noted[i] -> n : noted[i])
  }
}

/* Until nothing is found. */
inline look() {
  do
  :: resync -> look_at_everything()
  :: else ->
     if
     :: empty(queue) -> break
     :: queue?i, n ->
#if BUG != 7
        if
        :: resync -> look_at_everything()     /* finds n as well */
        :: else -> take()
        fi;
#else
        take();
#endif
        i = 0; n = 0
     fi
  od
}

/* An end state in which it sleeps and has missed a message is an error. */
proctype Subscription() {
  byte i, n;
  do
  :: noted[0] == MESSAGES && noted[1] == MESSAGES -> break
  :: woken -> woken = false; look()
  od
}

init {
  atomic { run Publisher(0); run Publisher(1); run ReceiveThread(); run Subscription() }
}
