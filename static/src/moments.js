// Moments as pages say them.
const TIME = { hour: "2-digit", minute: "2-digit", hourCycle: "h23" };

/** The time of a moment of today, such as "14:03"; of another day with its date. */
export function timeOf(moment) {
  const date = new Date(moment);
  const isToday = date.toDateString() === new Date().toDateString();
  const day = isToday ? {} : { day: "numeric", month: "short" };
  return isToday ? date.toLocaleTimeString([], TIME) : date.toLocaleString([], { ...day, ...TIME });
}
