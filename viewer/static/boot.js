// Runs before anything else. The key has done its work (it is in a cookie now), so it leaves the address bar;
// trame takes the place of its socket from the address and removes it again.
window.history.replaceState(null, "", `/?sessionURL=${encodeURIComponent(`ws://${window.location.host}/ws`)}${window.location.hash}`);
