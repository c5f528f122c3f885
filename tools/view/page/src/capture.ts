// SPDX-License-Identifier: Apache-2.0

/** Offers a file to the browser's downloads. */
export function download(content: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export function screenshot(canvas: HTMLCanvasElement, draw: () => void): Promise<Blob> {
  draw(); // the picture is kept until the browser composes the page
  return new Promise((resolve, reject) =>
    canvas.toBlob(
      (blob) => (blob ? resolve(blob) : reject(new Error("the browser cannot create a picture"))),
      "image/png",
    ),
  );
}

/** Records the picture as WebM from `start` to `stop`. */
export class Film {
  private recorder: MediaRecorder | undefined;

  constructor(private readonly canvas: HTMLCanvasElement) {}

  get isOn(): boolean {
    return this.recorder !== undefined;
  }

  start(framesPerSecond = 30): void {
    if (this.recorder) return;
    const parts: Blob[] = [];
    const type = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((each) =>
      MediaRecorder.isTypeSupported(each),
    );
    this.recorder = new MediaRecorder(this.canvas.captureStream(framesPerSecond), {
      mimeType: type,
      videoBitsPerSecond: 12_000_000,
    });
    this.recorder.ondataavailable = ({ data }) => parts.push(data);
    this.recorder.onstop = () => download(new Blob(parts, { type: "video/webm" }), "cohort.webm");
    this.recorder.start(1000);
  }

  stop(): void {
    this.recorder?.stop();
    this.recorder = undefined;
  }
}
