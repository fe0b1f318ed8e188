// SPDX-License-Identifier: Apache-2.0
import { Canvas, useFrame, useLoader, useThree } from "@react-three/fiber";
import { OrbitControls } from "@react-three/drei";
import { Suspense, useEffect } from "react";
import { ProgressiveMeshLoader } from "@vitrine/progressive-mesh";

function Bust({ url, ...props }) {
  const mesh = useLoader(ProgressiveMeshLoader, url);
  const { camera, size, viewport } = useThree();
  const sharpen = () => mesh.refineFor(camera, size.width * viewport.dpr, size.height * viewport.dpr).catch(console.warn);
  useEffect(() => {
    sharpen();
    return () => {
      useLoader.clear(ProgressiveMeshLoader, url);
      mesh.dispose();
    };
  }, [mesh]);
  let frames = 0;
  useFrame(() => ++frames % 30 === 0 && sharpen()); // every 30 frames, requests the detail that the camera needs now
  return <primitive object={mesh} {...props} />;
}

export default function App() {
  return (
    <Canvas camera={{ position: [0, 0, 300], far: 10_000 }}>
      <directionalLight position={[-100, 100, 100]} />
      <Suspense>
        <Bust url="bust.pmesh" />
      </Suspense>
      <OrbitControls />
    </Canvas>
  );
}
