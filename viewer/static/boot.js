// Runs before anything else. The key has done its work (it is in a cookie now), so it leaves the address bar;
// trame takes the place of its socket from the address, and how it is made, and removes both again.
const socket = encodeURIComponent(`ws://${window.location.host}/ws`);
window.history.replaceState(null, "", `/?sessionURL=${socket}&wsProxy=true&remove=wsProxy${window.location.hash}`);

// The socket hands over bytes. wslink would have blobs and read each in two parts, and each part would go to the browser's
// own process and back, one after the other, before the page hears what the server said.
class Socket extends WebSocket {
  set binaryType(kind) { super.binaryType = "arraybuffer"; }
  set onmessage(hear) {
    super.onmessage = ({ data }) => hear({ data: { slice: (from, to) => ({ arrayBuffer: async () => data.slice(from, to) }) } });
  }
}
window.WSLINK = { createWebSocket: (url) => new Socket(url) };
